// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/contract/robot.hpp"
#include "core/supervisor/supervisor.hpp"
#include "robot_agent/motion/velocity_writer.hpp"
#include "robot_agent/radio/notifier.hpp"

namespace adit::agent {

struct AgentSupervisorParams {
  std::string robot{};
  SupervisionParams supervision{};
  Log log{};
  /// Requests a restart of the agent's process. Called on the supervisor's strand.
  std::function<void(const std::string& why)> end{};
  /// Called at each check while the supervisor and the command component are alive, on the supervisor's
  /// strand.
  std::function<void()> alive{};
  VelocityType velocity{VelocityType::twist};  ///< Message type of the zero velocities for the driver.
};

/// The supervisor of an agent, on a strand of its own beside the command strand. Reports health and failures
/// to operators, sends zero to the driver while the command component is not running or silent, and requests
/// a restart of the agent as the last resort. The first unit passed to watch() is the command component.
class AgentSupervisor {
 public:
  /// Errors: those of the participants.
  static Result<std::unique_ptr<AgentSupervisor>> open(AgentSupervisorParams params, Executor& strand,
                                                       wire::Participant& radio, wire::Participant& robot,
                                                       Notifier& notifier);
  ~AgentSupervisor();
  AgentSupervisor(const AgentSupervisor&) = delete;
  AgentSupervisor& operator=(const AgentSupervisor&) = delete;

  /// Adds a unit. Call it before start().
  void watch(Unit& unit, PartSpec spec);
  /// Starts the units. Call it on the strand.
  void start();
  /// Call it after the strand's end.
  void stop();

  // Callable from any thread:

  /// Adds a line of the health report for a part that is no component, or replaces the line of that name.
  void note(contract::ComponentHealth row, std::optional<Time> heard = {});
  /// Restarts a component on the operator's request; "agent" restarts all. Errors: bad_argument,
  /// not_supported.
  Result<void> restart(const std::string& component);
  Result<void> set_policy(const std::string& component, bool automatic);
  /// Passes the health as a table for the robot's console to `answer`; called on the strand.
  void describe(std::function<void(const std::string&)> answer);

 private:
  class Impl;
  explicit AgentSupervisor(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace adit::agent
