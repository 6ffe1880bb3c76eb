// SPDX-License-Identifier: Apache-2.0
#include "basestation/alert/condition.hpp"

#include <algorithm>

#include "basestation/model/text.hpp"
#include "core/command/words.hpp"

namespace adit::station {
namespace {

/// Whether a component does not work and does not start by itself. A failing disk has a notification of its
/// own.
bool is_broken(const std::string& trouble) {
  return !trouble.ends_with(" starting") && !trouble.ends_with(" waiting") && !trouble.starts_with("store ");
}

/// The row of the health report that judges the driver's messages, not a component of the agent.
bool is_about_messages(const std::string& trouble) { return trouble.starts_with("inputs "); }

/// The code of the notification that says the same as the reason.
std::string code_of(Reason reason) {
  if (reason == Reason::driver_silent) return "driver_lost";
  if (reason == Reason::joystick_stale) return "joystick_lost";
  return std::string(name(reason));
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
  if (!robot.mine && !robot.holder.empty()) return out;
  if (robot.lost) return {{Ends::heard, "lost", "not heard any more", Reason::none}};
  const bool only_here = robot.stops.size() == 1 && robot.stops.front() == station;
  const bool stopped = robot.stopped || !robot.stops.empty();
  // Without a name the status that has it is still on its way.
  if (stopped && !only_here)
    out.push_back({Ends::stop_cleared, "stopped",
                   robot.stops.empty() ? "stopped" : "stopped by " + command::joined(robot.stops, ""),
                   Reason::stopped, !robot.stops.empty()});
  if (const Reason reason = standstill(robot); !stopped && reason != Reason::none)
    out.push_back({Ends::goes_on, code_of(reason), std::string(describe(reason)), reason});
  std::vector<std::string> components;
  bool messages = false;
  for (const std::string& trouble : robot.troubles) {
    if (is_about_messages(trouble))
      messages = true;
    else if (is_broken(trouble))
      components.push_back(trouble);
  }
  if (!components.empty())
    out.push_back({Ends::healthy, "component_failed", command::joined(components, ""), Reason::none});
  if (messages)
    out.push_back({Ends::understood, "inputs",
                   "what its driver sends cannot be used; health " + robot.name + " says why", Reason::none});
  return out;
}

}  // namespace adit::station
