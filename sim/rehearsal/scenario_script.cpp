// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "core/command/parse.hpp"
#include "core/wire/link_file.hpp"
#include "sim/rehearsal/random_script.hpp"
#include "sim/rehearsal/scenario_parts.hpp"

namespace adit::sim {
namespace {

using config::Node;

void check_command(const Node& line, const std::string& command, const Scenario& scenario) {
  if (!line.has("do")) return;
  auto request = command::parse(command);
  if (!request) return line.child("do").fail(request.error().reason, request.error().text);
  for (const std::string& robot : request->robots)
    if (!scenario.robot(robot))
      line.child("do").fail(Reason::unknown_robot, "expected one of the scenario's robots, not " + robot);
}

std::vector<std::string> read_names(const Node& node, const char* key,
                                    const std::vector<std::string>& known) {
  std::vector<std::string> names = node.texts(key, known);
  for (const std::string& name : names)
    if (std::find(known.begin(), known.end(), name) == known.end())
      node.child(key).fail(Reason::bad_argument, "expected names of this scenario, not " + name);
  if (names.empty()) node.fail(Reason::bad_argument, "expected at least one name in " + std::string(key));
  return names;
}

}  // namespace

wire::LinkProfile read_link(const Node& node, const std::string& file) {
  wire::LinkProfile out;
  if (!node.present()) return out;
  if (node.is_scalar()) {
    auto link = wire::load_link(node.as_text(), file);
    if (!link) node.fail(link.error().reason, link.error().text);
    return link ? *link : out;
  }
  out.name = node.text("name", "custom");
  wire::read_link_keys(node, out);
  return out;
}

std::vector<ScriptLine> read_script(const Node& root, const Scenario& scenario) {
  std::vector<ScriptLine> out;
  for (const Node& line : root.list_if("script")) {
    ScriptLine entry{read_time(line, "at", scenario), read_station(line, "by", scenario), line.text("do")};
    check_command(line, entry.command, scenario);
    (void)line.text("say", "");  // for those who look on when the script is played live
    out.push_back(std::move(entry));
  }
  std::stable_sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.at < b.at; });
  return out;
}

RandomScript read_random(const Node& node, const Scenario& scenario) {
  RandomScript out;
  std::vector<std::string> robots, stations;
  for (const RobotSpec& robot : scenario.robots) robots.push_back(robot.id);
  for (const StationSpec& station : scenario.stations) stations.push_back(station.id);
  out.commands = static_cast<int>(node.integer("commands", 1, 100000));
  out.from = read_time(node, "from", scenario);
  out.to = read_time(node, "to", scenario);
  if (out.to < out.from) node.fail(Reason::out_of_range, "expected from before to");
  out.by = read_names(node, "by", stations);
  out.robots = read_names(node, "robots", robots);
  out.verbs = node.texts("verbs", {"take", "lock", "release", "grant", "goto", "drive", "stop", "reset"});
  for (const std::string& verb : out.verbs)
    if (!is_random_verb(verb))
      node.child("verbs").fail(Reason::unknown_command,
                               "expected take, release, lock, unlock, grant, goto, drive, stop, reset, mode, "
                               "convoy, peeloff, yield or area, not " +
                                   verb);
  if (out.verbs.empty()) node.fail(Reason::bad_argument, "expected at least one verb");
  if (node.has("reach") && node.child("reach").is_list()) {
    const auto both = node.numbers("reach", 2, 2, config::positive_up_to(1000.0));
    if (both.size() == 2) out.reach = {both[0], both[1]};
  } else {
    out.reach.setConstant(node.number("reach", config::positive_up_to(1000.0), out.reach.x()));
  }
  return out;
}

}  // namespace adit::sim
