// SPDX-License-Identifier: Apache-2.0
#include "basestation/flow/arrival.hpp"

#include <cmath>
#include <utility>

namespace adit::station {

using namespace std::chrono_literals;

Arrival::Arrival(FlowDependencies dependencies, RobotCommand robot_command, Done answered, Done done)
    : Flow(dependencies, robot_command.robot, std::move(done)),
      robot_command_(std::move(robot_command)),
      on_answer_(std::move(answered)),
      goal_{robot_command_.request.number("X"), robot_command_.request.number("Y")} {}

void Arrival::start() {
  dependencies_.sender.send(robot_command_,
                            [weak = weak_from_this(), on_answer = on_answer_](const Answer& answer) {
                              on_answer(answer);
                              if (auto self = weak.lock()) static_cast<Arrival&>(*self).answered(answer);
                            });
  goal_before_ = view() ? view()->goal_id : 0;
}

void Arrival::answered(const Answer& answer) {
  if (over()) return;
  outcome_ = answer;
  if (!answer.accepted) return notify(answer);
  accepted_at_ = dependencies_.strand.now();
  behaviour_before_ = view() ? view()->behaviour_count : 0;
  timer_ = dependencies_.strand.every(100ms, [weak = weak_from_this()] {
    if (auto self = weak.lock()) static_cast<Arrival&>(*self).poll();
  });
}

void Arrival::poll() {
  const Time now = dependencies_.strand.now();
  const RobotView* robot_now = view();
  if (!robot_now) return;
  if (now - robot_now->last_heard > 30s)
    return end(Reason::no_answer, "the robot has not been heard for 30 s");
  if (!seen_) {
    // The state with the new goal may arrive later, or may have arrived before the answer.
    seen_ = robot_now->goal_id != goal_before_ &&
            std::hypot(robot_now->goal[0] - goal_[0], robot_now->goal[1] - goal_[1]) < 0.5;
    goal_id_ = robot_now->goal_id;
    if (!seen_ && now - accepted_at_ > 5s && robot_now->behaviour_count > behaviour_before_)
      return end(Reason::cancelled, "the robot does not show the goal");
    if (!seen_) return;
  }
  if (robot_now->goal_id != goal_id_) return end(Reason::cancelled, "the robot was given another goal");
  if (robot_now->goal_state == GoalState::reached) return end(Reason::none, "");
  if (robot_now->stopped) return end(Reason::stopped, "");
  if (robot_now->mode != "waypoint")
    return end(Reason::cancelled, "the robot left waypoint for " + robot_now->mode);
  const bool blocked = robot_now->goal_state == GoalState::blocked;
  if (blocked && robot_now->reason == Reason::goal_unreachable)
    return end(Reason::goal_unreachable, "no way leads to the goal");
  if (blocked && robot_now->reason != Reason::none && robot_now->reason != Reason::blocked)
    return end(robot_now->reason, std::string(describe(robot_now->reason)));
  if (robot_now->goal_state != GoalState::blocked) {
    blocked_ = false;
  } else if (!blocked_) {
    blocked_ = true;
    blocked_since_ = now;
  } else if (now - blocked_since_ > 5s) {
    return end(Reason::blocked, "every path to the goal has been blocked for 5 s");
  }
}

void Arrival::cancel(Reason reason, const std::string& text) {
  const bool goes_on = text.empty() && outcome_.accepted;
  end(reason, goes_on ? "not waited for any longer; the robot goes on to its goal" : text);
}

void Arrival::end(Reason reason, const std::string& text) {
  timer_.cancel();
  outcome_.accepted = reason == Reason::none;
  outcome_.reason = reason;
  outcome_.text = text;
  if (const RobotView* robot_now = view()) outcome_.holder = robot_now->holder;
  notify(outcome_);
}

}  // namespace adit::station
