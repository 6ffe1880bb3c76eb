// SPDX-License-Identifier: Apache-2.0
#include "basestation/alert/condition.hpp"

#include <algorithm>

#include "basestation/model/text.hpp"
#include "core/command/words.hpp"

namespace adit::station {
namespace {

/// Whether a component does not work and does not start by itself.
bool is_broken(const std::string& trouble) {
  return !trouble.ends_with(" starting") && !trouble.ends_with(" waiting");
}

/// Rows of the health report that judge messages from outside, not a component of the agent.
bool is_about_messages(const std::string& trouble) {
  return trouble.starts_with("inputs ") || trouble.starts_with("radio ");
}

/// The reason for which the robot does not do what it was sent to do; none: it does, or has nothing to do.
Reason standstill(const Robot& robot) {
  if (robot.goal_state == GoalState::blocked)
    return robot.reason == Reason::none ? Reason::blocked : robot.reason;
  if (robot.moving_allowed || robot.mode.empty()) return Reason::none;
  // With a new holder a robot is in hold, and nothing is lost.
  if (robot.reason == Reason::stopped || robot.reason == Reason::not_holder) return Reason::none;
  return robot.reason;
}

}  // namespace

std::vector<Condition> conditions_of(const Robot& robot, const std::string& station) {
  std::vector<Condition> out;
  if (!robot.mine) return out;
  if (robot.lost) return {{Ends::heard, "lost", "not heard any more", Reason::none}};
  const bool only_here = robot.stops.size() == 1 && robot.stops.front() == station;
  const bool stopped = robot.stopped || !robot.stops.empty();
  if (stopped && !only_here)
    out.push_back({Ends::stop_cleared, "stopped",
                   robot.stops.empty() ? "stopped" : "stopped by " + command::joined(robot.stops, ""),
                   Reason::stopped});
  if (const Reason reason = standstill(robot); !stopped && reason != Reason::none)
    out.push_back({Ends::goes_on, std::string(name(reason)), std::string(describe(reason)), reason});
  std::vector<std::string> components, messages;
  for (const std::string& trouble : robot.troubles)
    if (is_broken(trouble)) (is_about_messages(trouble) ? messages : components).push_back(trouble);
  if (!components.empty())
    out.push_back({Ends::healthy, "component_failed", command::joined(components, ""), Reason::none});
  if (!messages.empty())
    out.push_back({Ends::understood, "inputs", command::joined(messages, ""), Reason::none});
  return out;
}

}  // namespace adit::station
