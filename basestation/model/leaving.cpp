// SPDX-License-Identifier: Apache-2.0
#include "basestation/model/leaving.hpp"

#include "basestation/model/text.hpp"

namespace adit::station {
namespace {

AfterRelease resting(std::string text) { return {true, std::move(text)}; }
AfterRelease moving(const std::string& text) { return {false, text + ", without a holder"}; }
AfterRelease ending(const std::string& what) { return {false, "ends " + what + ", and holds"}; }

AfterRelease to_goal(const Robot& robot) {
  const std::string why = standstill_text(robot);
  const bool blocked = robot.goal_state == GoalState::blocked || !why.empty();
  return moving("drives on to its goal " + fixed(robot.goal.x(), 1) + " " + fixed(robot.goal.y(), 1) +
                (blocked ? " as soon as it can" : "") + (why.empty() ? "" : " (" + why + ")"));
}

}  // namespace

AfterRelease after_release(const Robot& robot) {
  using enum ExplorationPhase;
  if (robot.stopped) return resting("stays stopped");
  if (robot.mode == "hold") return resting("stays in hold");
  if (robot.mode == "waypoint" && robot.goal_state == GoalState::reached) return resting("stays at its goal");
  if (robot.mode == "explore" && (robot.exploration.phase == done || robot.exploration.phase == ended))
    return resting("stays where its exploration ended");
  if (robot.mode.empty()) return moving("has not said what it does");
  if (robot.lost) return {false, "is not heard; it was in " + robot.mode + ", and keeps you as its holder"};
  if (robot.mode == "waypoint") return to_goal(robot);
  if (robot.mode == "explore") return moving("goes on exploring");
  if (robot.mode == "external") return moving("is driven on by the program on it");
  // Rule 7: these modes end when the holder changes.
  if (is_by_hand(robot.mode)) return ending("its drive by hand");
  if (robot.mode == "convoy_follow")
    return ending("to follow " + (robot.convoy.empty() ? "its convoy" : robot.convoy.front()));
  if (robot.mode == "get_out") return ending("to make way");
  return moving("stays in " + robot.mode);
}

}  // namespace adit::station
