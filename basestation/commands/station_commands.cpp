// SPDX-License-Identifier: Apache-2.0
#include "basestation/commands/station_commands.hpp"

#include <algorithm>

#include "basestation/findings/report.hpp"
#include "basestation/findings/stairs_report.hpp"
#include "basestation/model/json.hpp"
#include "basestation/report/json.hpp"
#include "basestation/report/table.hpp"
#include "basestation/report/text.hpp"
#include "core/command/words.hpp"

namespace adit::station {
namespace {

using command::Request;
using command::verb;
using nlohmann::json;

Outcome robot_status(const Request& request, const QuerySubject& subject, const RobotView& robot) {
  json values = json_of(described(robot, subject.now));
  values["notifications"] = notices_json(subject.fleet, robot.name, subject.now);
  return done_outcome(request, status_text(subject.fleet, robot, subject.now), values);
}

Outcome station_status(const Request& request, const QuerySubject& subject) {
  const auto& [params, fleet, counts, content, up, now] = subject;
  json values = list_json(fleet, now);
  values.update({{"station", params.name},
                 {"link", params.link},
                 {"up_for", seconds(up)},
                 {"commands", json_of(counts)},
                 {"notifications", notices_json(fleet, "", now)}});
  return done_outcome(
      request,
      "station " + params.name + (params.link.empty() ? ", no link profile" : " on " + params.link) +
          ", up " + fixed(seconds(up), 0) + " s; commands " + std::to_string(counts.sent) + " sent, " +
          std::to_string(counts.accepted) + " accepted, " + std::to_string(counts.refused) + " refused, " +
          std::to_string(counts.unanswered) + " unanswered\n" + list_text(fleet, now),
      values);
}

Outcome unknown_robot(const Request& request, const Fleet& fleet, const std::string& robot) {
  const std::string line = robot + ": " + unknown_text(fleet);
  return refused_outcome(request, Reason::unknown_robot, line, line + "\n");
}

/// Findings stay available when their robot is lost.
Outcome list_findings(const Request& request, const Fleet& fleet, Content& content) {
  const auto& all = content.desk().all();
  for (const std::string& robot : request.robots) {
    const bool found =
        std::any_of(all.begin(), all.end(), [&](const auto& entry) { return entry.first.robot == robot; });
    if (!found && !fleet.robot(robot)) return unknown_robot(request, fleet, robot);
  }
  const FoundReport report = content.found(fleet, request.robots);
  Outcome outcome =
      done_outcome(request, findings_text(report), findings_json(report, content.desk(), content.book()));
  const std::uint64_t refused = content.pieces().refused(transfer::Kind::findings);
  outcome.json["refused_pieces"] = refused;
  if (refused > 0) outcome.text += std::to_string(refused) + " pieces of findings refused\n";
  const std::uint64_t photos = content.pieces().refused(transfer::Kind::photos);
  outcome.json["refused_photo_pieces"] = photos;
  if (photos > 0) outcome.text += std::to_string(photos) + " pieces of photos refused\n";
  return outcome;
}

}  // namespace

std::string unknown_text(const Fleet& fleet) {
  return "no robot of that name has been heard; known robots: " +
         command::joined(fleet.robot_names(), "none");
}

Outcome query_outcome(const Request& request, const QuerySubject& subject) {
  const Fleet& fleet = subject.fleet;
  if (request.verb == verb("findings")) return list_findings(request, fleet, subject.content);
  if (request.verb == verb("stairs")) {
    const StairsReport report =
        stairs_report(subject.content.desk(), subject.content.book(), subject.content.chunks(), fleet);
    return done_outcome(request, stairs_text(report), json_of(report));
  }
  std::vector<const RobotView*> selection;
  for (const std::string& robot : request.robots) {
    selection.push_back(fleet.robot(robot));
    if (!selection.back()) return unknown_robot(request, fleet, robot);
  }
  if (request.verb == verb("list"))
    return done_outcome(request, list_text(fleet, subject.now), list_json(fleet, subject.now));
  if (request.verb == verb("status"))
    return selection.empty() ? station_status(request, subject)
                             : robot_status(request, subject, *selection.front());
  if (request.verb == verb("net")) {
    const NetworkReport report = network_report(fleet, subject.now);
    return done_outcome(request, net_text(report, subject.params), json_of(report));
  }
  if (request.verb == verb("health")) {
    if (selection.empty())
      for (const auto& [name, robot] : fleet.robots()) selection.push_back(&robot);
    const HealthReport report = health_report(selection);
    return done_outcome(request, health_text(report), json_of(report));
  }
  const std::vector<Action> rows = actions({selection.begin(), selection.end()});
  return done_outcome(request, actions_text(rows), {{"actions", actions_json(rows)}});
}

}  // namespace adit::station
