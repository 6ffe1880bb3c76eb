// SPDX-License-Identifier: Apache-2.0
#include "basestation/findings/stairs_report.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "basestation/findings/placed.hpp"
#include "basestation/report/table.hpp"
#include "basestation/report/text.hpp"
#include "core/command/words.hpp"
#include "core/findings/merge_stairs.hpp"
#include "core/findings/stairs_data.hpp"

namespace adit::station {
namespace {

constexpr double kRounding = 5e-4;  // Of a platform's step, m.

Climber climber(const RobotView& robot, const Staircase& stairs) {
  Climber out{.robot = robot.name};
  if (!robot.described)
    out.reason = "has not said what it climbs";
  else if (!robot.climbs_stairs)
    out.reason = "climbs no stairs";
  else if (robot.max_step + kRounding < stairs.rise)
    out.reason = "climbs steps of " + fixed(robot.max_step, 2) + " m at most";
  out.may = out.reason.empty();
  return out;
}

const FindingBook::Judgement& judgement(const FindingBook& book, const findings::Key& key) {
  static const FindingBook::Judgement none;
  const FindingBook::Judgement* entry = book.find(key);
  return entry ? *entry : none;
}

StairsItem item_of(const findings::MergedStairs& merged, const FindingBook& book, const Fleet& fleet) {
  StairsItem item{.stairs = merged.stairs};
  std::set<std::string> robots;
  std::vector<findings::SeenStairs> accepted;
  for (const findings::SeenStairs& seen : merged.seen) {
    const auto& entry = judgement(book, seen.key);
    item.findings.push_back(entry.number);
    robots.insert(seen.key.robot);
    if (entry.verdict != Verdict::rejected) accepted.push_back(seen);
    // The number that operators know longest, whichever robot found it.
    if (item.number != 0 && item.number < entry.number) continue;
    item.number = entry.number;
    item.verdict = entry.verdict;
    item.note = entry.note;
  }
  std::sort(item.findings.begin(), item.findings.end());
  item.robots.assign(robots.begin(), robots.end());
  if (item.verdict != Verdict::rejected && accepted.size() < merged.seen.size())
    item.stairs = findings::combined(accepted);
  for (const auto& [name, robot] : fleet.robots()) item.fleet.push_back(climber(robot, item.stairs));
  return item;
}

}  // namespace

StairsReport stairs_report(const FindingDesk& desk, const FindingBook& book, const ChunkStore& chunks,
                           const Fleet& fleet) {
  StairsReport report;
  std::vector<findings::SeenStairs> seen;
  for (const auto& [key, finding] : desk.all()) {
    if (finding.kind != findings::kStairs || finding.withdrawn) continue;
    if (const auto stairs = findings::stairs_of(finding, placed(finding, chunks)))
      seen.push_back({key, *stairs});
    else
      ++report.unreadable;
  }
  for (const findings::MergedStairs& merged : findings::merge_stairs(std::move(seen)))
    report.stairs.push_back(item_of(merged, book, fleet));
  std::ranges::sort(report.stairs, {}, &StairsItem::number);
  return report;
}

std::string stairs_text(const StairsReport& report) {
  std::string out = "no staircase was found yet\n";
  if (!report.stairs.empty()) {
    std::vector<std::vector<std::string>> rows{{"ID", "DIRECTION", "FLOORS M", "STEPS", "RISE M", "RUN M",
                                                "WIDTH M", "SEEN BY", "WHO MAY CLIMB", "VERDICT"}};
    for (const StairsItem& item : report.stairs) {
      const Staircase& s = item.stairs;
      rows.push_back({std::to_string(item.number), std::to_string(degrees_of(s)) + "d",
                      fixed(s.floor_below(), 1) + " -> " + fixed(s.floor_above(), 1), std::to_string(s.steps),
                      fixed(s.rise, 3), fixed(s.run, 3), fixed(s.width, 2) + " +- " + fixed(s.sigma.width, 2),
                      command::joined(item.robots, "-"), command::joined(climbers_of(item), "none"),
                      to_string(item.verdict)});
    }
    out = table(rows);
  }
  const std::string unreadable = unreadable_text(report);
  return unreadable.empty() ? out : out + unreadable + "\n";
}

}  // namespace adit::station
