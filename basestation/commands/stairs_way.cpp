// SPDX-License-Identifier: Apache-2.0
#include "basestation/commands/stairs_way.hpp"

#include <algorithm>
#include <string>

namespace adit::station {
namespace {

command::Request goal_at(const std::string& robot, const Eigen::Vector2d& place, double floor) {
  command::Request goal(command::verb("goto"), {robot});
  goal.values = {{"R", {robot}, {}}, {"X", {}, {place.x()}}, {"Y", {}, {place.y()}}, {"Z", {}, {floor}}};
  return goal;
}

}  // namespace

Result<std::vector<command::Request>> stairs_way(const command::Request& request,
                                                 const StairsReport& report) {
  const double wanted = request.number("ID");
  const auto item = std::ranges::find_if(report.stairs, [wanted](const StairsItem& stairs) {
    return std::ranges::any_of(stairs.findings, [wanted](std::uint32_t number) { return number == wanted; });
  });
  if (item == report.stairs.end())
    return {Reason::out_of_range, "there is no staircase of that ID; `stairs` lists them"};
  const std::string id = std::to_string(item->number);
  if (item->verdict == Verdict::rejected)
    return {Reason::bad_argument,
            "staircase " + id + " is rejected; `finding " + id + " reopen` takes that back"};
  const std::string& robot = request.robots.front();
  const auto climber = std::ranges::find(item->fleet, robot, &Climber::robot);
  if (climber != item->fleet.end() && !climber->may)
    return {Reason::goal_over_stairs, robot + " " + climber->reason + "; it does not take staircase " + id};
  const Staircase& stairs = item->stairs;
  const Eigen::Vector2d beyond = kClearOfStairs * stairs.direction();
  const auto below = goal_at(robot, stairs.foot.head<2>() - beyond, stairs.floor_below());
  const auto above = goal_at(robot, stairs.top().head<2>() + beyond, stairs.floor_above());
  const bool up = request.word("WAY") == "up";
  std::vector<command::Request> goals;
  if (std::ranges::find(item->robots, robot) == item->robots.end()) goals.push_back(up ? below : above);
  goals.push_back(up ? above : below);
  return goals;
}

}  // namespace adit::station
