// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>

#include "core/exec/virtual_runtime.hpp"
#include "core/store/memory_disk.hpp"
#include "core/time/random.hpp"
#include "core/wire/memory/simulated_network.hpp"
#include "sim/driver/robot_driver.hpp"
#include "sim/rehearsal/agent_factory.hpp"
#include "sim/rehearsal/witness.hpp"

namespace adit::sim {

/// What all machines of a rehearsal share; outlives them.
struct Stage {
  const Scenario& scenario;
  VirtualScheduler& scheduler;
  wire::SimulatedNetwork& network;
  Simulation& simulation;
  Witness& witness;
  const AgentFactory& make_agent;
  const WireDecorator& parent_wire;
};

/// One robot: its computer with the agent and the agent's parent, and its driver, on one clock. The
/// computer's agent can crash; parent and driver go on.
class RobotMachine {
 public:
  /// `random`: of this robot alone.
  RobotMachine(Stage& stage, std::size_t index, const RobotSpec& spec, Random random);
  ~RobotMachine();
  Result<void> start();
  /// The agent's process dies in this instant: its parent sends zero 20 ms later and starts it again
  /// after 0.5 s. Nothing happens when it is dead already.
  void crash();
  /// A component of the agent throws or hangs; nothing happens while the agent is dead.
  Result<void> inject(const std::string& component, ComponentFault fault);
  /// A component of the agent reports it; nothing happens while the agent is dead.
  Result<void> find(findings::Finding finding);
  /// A program beside the agent reports a finding where the robot is, with a photo of that many kB.
  Result<void> report(const std::string& kind, int kilobytes);
  /// A program beside the agent writes that velocity (body frame) for mode `external`, 20 times a second.
  Result<void> steer(const Twist2& velocity, Duration duration);
  /// A second agent with this robot's name, on a computer of its own without a driver.
  Result<void> add_twin(Duration duration);
  /// The computer's clock goes on by so much at once.
  void jump_clock(Duration by);
  RobotDriver& driver() { return *driver_; }
  /// The disk is full as long as it was filled more often than freed.
  void fill_disk(bool full);
  /// Why the agent could not be started again, if so.
  const Result<void>& health() const { return health_; }

 private:
  struct Parent;
  struct Agent;
  struct Program;
  Result<void> start_agent();
  /// Starts a program on the robot, with a wire in the robot's domain.
  std::unique_ptr<Program> start_program(const std::string& name);

  Stage& stage_;
  std::size_t index_;
  const RobotSpec& spec_;
  Random random_;
  Duration clock_offset_;
  std::uint32_t domain_;
  std::shared_ptr<store::MemoryDisk> disk_;  ///< Disk of the agent's computer; outlives crashes.
  int disk_full_{};
  // In the order they are needed: a wire before what speaks on it.
  std::unique_ptr<Runtime> driver_runtime_{};
  std::shared_ptr<Executor> driver_strand_{};
  std::unique_ptr<wire::Participant> driver_wire_{};
  std::unique_ptr<RobotDriver> driver_{};
  std::unique_ptr<Parent> parent_{};
  std::unique_ptr<Agent> agent_{};
  std::unique_ptr<Program> program_{};
  std::unique_ptr<Program> reporter_{};
  int reports_{};
  std::unique_ptr<Agent> twin_{};
  Result<void> health_{};
};

}  // namespace adit::sim
