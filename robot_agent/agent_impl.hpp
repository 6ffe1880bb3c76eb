#pragma once
#include <mutex>

#include "robot_agent/command_component.hpp"
#include "robot_agent/motion/scans.hpp"

namespace adit::agent {

// What a seed is used for beside the epoch; each has its own sequence.
inline constexpr std::uint64_t kIdentitySalt = 1;
inline constexpr std::uint64_t kFindingsSalt = 2;

/// The parts of an agent, composed: four units on strands of their own, what they share, and who watches
/// them. Private to agent.cpp.
struct Agent::Impl {
  Impl(const AgentParams& agent_params, Runtime& agent_runtime);
  /// First nothing runs any more, then the parts go.
  ~Impl();
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  Result<void> open(wire::Participant& radio, wire::Participant& robot);
  Unit* find(const std::string& component);
  Executor& command_strand() { return *command.slot()->strand; }

  const AgentParams& params;
  Runtime& runtime;
  wire::Participant* robot_wire{};
  std::unique_ptr<Context> context{};
  Unit command, planner, router, sensors;
  std::shared_ptr<Strand> watch_strand;
  std::shared_ptr<Strand> disk_strand{};  ///< null: there is no disk, or one that takes no time
  std::unique_ptr<AgentSupervisor> watch{};

 private:
  /// Writes what waits for the disk, for a bounded time.
  void end_disk();
  std::mutex mutex_{};  // guards the next one: a planner that hangs may still be making it
  std::shared_ptr<const nav::PlannerLibrary> library_{};

  StateKeeper::Outputs keeper_outputs();
  std::shared_ptr<const nav::PlannerLibrary> library();
  FindingSync::Outputs findings_outputs();
  UnitParams command_unit();
  UnitParams planner_unit();
  UnitParams router_unit();
  UnitParams sensors_unit();
};

}  // namespace adit::agent
