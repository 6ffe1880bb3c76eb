#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/supervisor/supervisor.hpp"
#include "robot_agent/motion/velocity_writer.hpp"
#include "robot_agent/radio/notifier.hpp"
#include "robot_agent/supervisor/component_row.hpp"

namespace adit::agent {

struct AgentSupervisorParams {
  std::string robot{};
  SupervisionParams supervision{};
  Log log{};
  /// The agent's process is to end and to be started anew. On the supervisor's strand.
  std::function<void(const std::string& why)> end{};
  /// Supervisor and command component both live: at each look, on the supervisor's strand.
  std::function<void()> alive{};
  VelocityType velocity{VelocityType::twist};  ///< of the zeros for the driver
};

/// The supervisor of an agent, on a strand of its own beside the command strand: tells operators of health
/// and failures, sends zero to the driver while the command component is away or silent, has the agent
/// restarted when nothing else helps. The first unit watched is the command component.
class AgentSupervisor {
 public:
  /// Errors of the wires.
  static Result<std::unique_ptr<AgentSupervisor>> open(AgentSupervisorParams params, Executor& strand,
                                                       wire::Participant& radio, wire::Participant& robot,
                                                       Notifier& notifier);
  ~AgentSupervisor();
  AgentSupervisor(const AgentSupervisor&) = delete;
  AgentSupervisor& operator=(const AgentSupervisor&) = delete;

  /// Before start().
  void watch(Unit& unit, PartSpec spec);
  /// Starts the units, on the strand.
  void start();
  /// After the strand's end.
  void stop();

  // From any thread.

  /// A line of the health report that is no component's; replaces the one of that name.
  void note(ComponentRow row);
  /// The operator's word. "agent" restarts the whole of it. Errors: bad_argument, not_supported.
  Result<void> restart(const std::string& component);
  Result<void> set_policy(const std::string& component, bool automatic);
  /// Health as a table for the robot's console; called on the strand.
  void describe(std::function<void(const std::string&)> answer);

 private:
  class Impl;
  explicit AgentSupervisor(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace adit::agent
