// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/behaviour/modes/waypoint.hpp"

#include <cmath>

namespace adit::agent {
namespace {

std::string text_of(const Progress& progress) {
  static constexpr std::array kSides{"", " ahead", " on its left", " behind it", " on its right"};
  if (progress.reason == Reason::stuck) return "no progress towards the goal for 45 s";
  if (progress.reason == Reason::start_in_collision)
    return std::string("an obstacle") + kSides[static_cast<std::size_t>(progress.in_collision)] +
           " touches the robot, or nearly, and no motion leads away from it";
  switch (progress.cause) {
    case nav::Cause::mover:
      return "something that moves is in the way; the robot waits for it";
    case nav::Cause::peer:
      return "another robot of the team is in the way; the robot waits for it";
    case nav::Cause::border:
      return "the border of an area is in the way";
    case nav::Cause::fixed:
    case nav::Cause::none:
      break;
  }
  return progress.gave_up() ? "every path to the goal is blocked"
                            : "an obstacle is in the way; the robot tries to pass it";
}

}  // namespace

void WaypointMode::note(Facts& facts, Time) const {
  facts.goal_known = goal_.known;
  facts.goal_free = !goal_.known || context_.goal_free(goal_.place.head<2>());
}

void WaypointMode::enter(Time) {
  driven_ = 0.0;
  last_.reset();
  used_up_ = false;
  reported_ = Reason::none;
}

void WaypointMode::leave(Time) { unreachable_reported_ = false, reported_ = Reason::none; }

void WaypointMode::clear() { goal_ = {.id = goal_.id}; }

void WaypointMode::tick(bool passes, Time now) {
  if (!goal_.known) return;
  if (navigated_.arrived && !goal_.reached && passes) {
    goal_.reached = true;
    context_.notify_holder(Severity::info, "arrived", Reason::none, "goal reached");
  }
  count(passes);
  if (goal_.reached || used_up_)
    context_.output.write(Stand{}, now);
  else
    context_.output.write(
        GoTo{.goal = {goal_.place.x(), goal_.place.y(), goal_.on_floor ? std::nan("") : goal_.place.z()},
             .id = goal_.id},
        now);
  watch(progress(passes).state);
}

void WaypointMode::count(bool passes) {
  const auto pose = context_.pose ? context_.pose() : std::nullopt;
  if (!pose || !passes || goal_.reached || navigated_.goal_seen || used_up_) return last_.reset();
  // Noise of a stationary robot's odometry counts no metres.
  constexpr double kStep = 0.1;  // m
  if (!last_) last_ = pose->position();
  const double step = (pose->position() - *last_).norm();
  if (step >= kStep) {
    last_ = pose->position();
    driven_ += step;
  }
  const double stopping = context_.stopping ? context_.stopping() : 0.0;
  if (driven_ + stopping < budget_) return;
  used_up_ = true;
  context_.notify_holder(Severity::warning, "unknown_budget", Reason::unknown_budget,
                         std::string(describe(Reason::unknown_budget)));
}

void WaypointMode::limit_unknown(double metres) {
  constexpr double kLeast = 20.0, kDetour = 1.5;  // m, times the straight line
  const auto pose = context_.pose ? context_.pose() : std::nullopt;
  const double straight = pose ? (goal_.place.head<2>() - pose->position()).norm() : 0.0;
  budget_ = std::isnan(metres) ? std::max(kLeast, kDetour * straight) : metres;
}

void WaypointMode::watch(GoalState state) {
  const bool unreachable = state == GoalState::blocked && navigated_.unreachable() && !used_up_;
  if (unreachable && !unreachable_reported_)
    context_.notify_holder(Severity::warning, "unreachable", unreachable_because(),
                           navigated_.refusal == Reason::none ? "no way leads to the goal"
                           : navigated_.refusal_text.empty()  ? std::string(describe(navigated_.refusal))
                                                              : navigated_.refusal_text);
  unreachable_reported_ = unreachable;
  const bool drives = state == GoalState::active || state == GoalState::blocked;
  if (!drives || navigated_.reason == Reason::none || unreachable || used_up_) {
    reported_ = Reason::none;
  } else if (navigated_.reason != reported_) {
    reported_ = navigated_.reason;
    context_.notify_holder(Severity::warning, std::string(name(reported_)), reported_, text_of(navigated_));
  }
}

Result<void> WaypointMode::check_goal(const Eigen::Vector3d& goal, Facts& facts) const {
  // z is NaN if it was not given.
  if (!goal.head<2>().allFinite() || std::isinf(goal.z()) || goal.head<2>().norm() > kFarthestPlace)
    return {Reason::out_of_range, "goto: the goal is no place within 10 km"};
  facts.goal_known = true;
  facts.goal_free = context_.goal_free(goal.head<2>());
  return {};
}

void WaypointMode::set_goal(const Eigen::Vector3d& goal) {
  const bool given = !std::isnan(goal.z()), on_floor = !given && !context_.height;
  const double height = given ? goal.z() : on_floor ? 0.0 : context_.height();
  goal_ = {true, false, goal_.id + 1, {goal.x(), goal.y(), height}, on_floor};
  navigated_ = {};
  budget_ = std::numeric_limits<double>::infinity();
}

ModeProgress WaypointMode::progress(bool passes) const {
  ModeProgress p{.state = GoalState::none, .goal_id = goal_.id, .goal = goal_.place};
  if (!goal_.known) return p;
  p.state = goal_.reached        ? GoalState::reached
            : !passes            ? GoalState::kept
            : used_up_           ? GoalState::blocked
            : navigated_.blocked ? GoalState::blocked
                                 : GoalState::active;
  if (p.state == GoalState::blocked)
    p.reason = used_up_                   ? Reason::unknown_budget
               : navigated_.unreachable() ? unreachable_because()
                                          : why_blocked();
  return p;
}

Reason WaypointMode::why_blocked() const {
  return navigated_.reason == Reason::none ? Reason::blocked : navigated_.reason;
}

void WaypointMode::store(StoredBehaviour& stored) const {
  stored.goal_known = goal_.known;
  stored.goal_reached = goal_.reached;
  stored.goal_id = goal_.id;
  stored.goal = goal_.place;
  stored.goal_on_floor = goal_.on_floor;
}

void WaypointMode::restore(const StoredBehaviour& stored) {
  goal_ = {stored.goal_known, stored.goal_reached, stored.goal_id, stored.goal, stored.goal_on_floor};
}

}  // namespace adit::agent
