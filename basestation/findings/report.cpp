// SPDX-License-Identifier: Apache-2.0
#include "basestation/findings/report.hpp"

#include <algorithm>

#include "basestation/report/table.hpp"
#include "basestation/report/text.hpp"
#include "core/command/words.hpp"

namespace adit::station {
namespace {

using findings::Finding;

std::vector<const Finding*> chosen(const FindingDesk& desk, const std::vector<std::string>& robots) {
  std::vector<const Finding*> rows;
  for (const auto& [key, finding] : desk.all())
    if (robots.empty() || std::find(robots.begin(), robots.end(), key.robot) != robots.end())
      rows.push_back(&finding);
  std::stable_sort(rows.begin(), rows.end(),
                   [](const Finding* a, const Finding* b) { return a->importance > b->importance; });
  return rows;
}

/// Age of a finding by the robot's clock, s; negative: unknown.
double age(const Finding& finding, const Fleet& fleet) {
  const RobotView* robot = fleet.robot(finding.key.robot);
  if (!robot || !robot->located || robot->stamp < finding.stamp) return -1.0;
  return static_cast<double>(robot->stamp - finding.stamp) * 1e-9;
}

}  // namespace

std::string findings_text(const FindingDesk& desk, const Fleet& fleet,
                          const std::vector<std::string>& robots) {
  const auto list = chosen(desk, robots);
  std::string out;
  if (list.empty()) {
    out = "nothing was found yet\n";
  } else {
    std::vector<std::vector<std::string>> rows{{"ROBOT", "KIND", "X", "Y", "Z", "AGE S", "TEXT", "ID"}};
    for (const Finding* f : list) {
      const double seconds_ago = age(*f, fleet);
      rows.push_back({f->key.robot, command::clean(f->kind, Finding::kKind), fixed(f->position[0], 2),
                      fixed(f->position[1], 2), fixed(f->position[2], 2),
                      seconds_ago < 0 ? "-" : fixed(seconds_ago, 0), command::clean(f->text, Finding::kText),
                      findings::id_text(f->key.id)});
    }
    out = table(rows);
  }
  for (const auto& [robot, says] : desk.robots()) {
    if (!robots.empty() && std::find(robots.begin(), robots.end(), robot) == robots.end()) continue;
    const auto here =
        std::count_if(list.begin(), list.end(), [&](const Finding* f) { return f->key.robot == robot; });
    if (says.kept > static_cast<std::uint32_t>(here))
      out += robot + " has " + std::to_string(says.kept) + ", " + std::to_string(here) + " are here\n";
    if (says.overflowed > 0) out += robot + " had no room for " + std::to_string(says.overflowed) + " more\n";
  }
  return out;
}

nlohmann::json findings_json(const FindingDesk& desk, const Fleet& fleet,
                             const std::vector<std::string>& robots) {
  nlohmann::json out = nlohmann::json::array();
  for (const Finding* f : chosen(desk, robots)) {
    nlohmann::json row{{"robot", f->key.robot},
                       {"id", findings::id_text(f->key.id)},
                       {"kind", command::clean(f->kind, Finding::kKind)},
                       {"importance", f->importance},
                       {"position", f->position},
                       {"text", command::clean(f->text, Finding::kText)},
                       {"data", f->data}};
    if (const double seconds_ago = age(*f, fleet); seconds_ago >= 0) row["age"] = seconds_ago;
    out.push_back(std::move(row));
  }
  return out;
}

}  // namespace adit::station
