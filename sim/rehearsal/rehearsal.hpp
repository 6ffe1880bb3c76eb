// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <map>
#include <memory>
#include <vector>

#include "core/exec/virtual_runtime.hpp"
#include "sim/driver/robot_driver.hpp"
#include "sim/rehearsal/agent_factory.hpp"
#include "sim/rehearsal/report.hpp"
#include "sim/rehearsal/scenario.hpp"
#include "sim/rehearsal/witness.hpp"
#include "sim/world/simulation.hpp"

namespace adit::station {
class Station;
}

namespace adit::sim {

/// A run while it lasts.
struct RunState {
  Duration now{};
  const Simulation& simulation;
  const Witness& witness;
  /// The run's expectations are settled, and no line of the script and no fault is still to come or lasts.
  bool decided{};
};

struct RunParams {
  std::uint64_t seed{1};
  int workers{2};  ///< Threads for the heavy work of one run, [1, 64].
  AgentFactory make_agent{};
  WireDecorator parent_wire{};  ///< Decorates the wire of each robot's parent process; empty: nothing does
  std::string trajectories{};   ///< Folder for the robots' trajectories (TUM files); empty: none.
  std::function<void(Duration)> progress{};  ///< Called with the virtual time, once per virtual second.
  /// Ends the run before its duration; asked every Trail::kPeriod. Empty: never.
  std::function<bool(const RunState&)> ended{};
  std::string record{};  ///< MCAP file for all messages; empty: none.
  /// Called for every frame of the radio and the inner networks. Empty: never.
  std::function<void(const wire::SampleEvent&)> on_frame{};
  /// Called at 50 Hz. Empty: never.
  std::function<void(Duration, const Simulation&)> on_truth{};
  OnUse on_use{};  ///< See VirtualParams.
  /// Called for each station that is not dead, every Trail::kPeriod. Empty: never.
  std::function<void(Duration, const station::Station&)> on_station{};
};

/// The path of a robot or a person, for the picture.
struct Trail {
  static constexpr Duration kPeriod{100ms};
  std::vector<Pose2> poses{};  ///< True poses, one per period, world frame.
};

struct RunOutcome {
  RunReport report{};
  std::map<std::string, Trail> trails{};  ///< By robot.
  std::vector<Trail> people{};            ///< In the order of the scenario.
  std::vector<Goal> goals{};              ///< Accepted goals.
  std::vector<Collision> collisions{};
};

/// Appends the present poses of the people to their trails.
void add_people(const Simulation& simulation, std::vector<Trail>& trails);

/// What a scenario leaves to its seed.
struct Draws {
  std::vector<ScriptLine> script{};
  std::vector<Fault> faults{};
};
Draws draw(const Scenario& scenario, std::uint64_t seed);

/// Builds a scenario's world; it may be shared by many runs. Errors name the file.
Result<std::shared_ptr<const World>> make_world(const WorldSpec& spec);
/// The robots as the simulation takes them, with their platforms.
std::vector<RobotStart> make_starts(const Scenario& scenario);
/// What a robot's driver takes from its scenario: battery, type of /cmd_vel.
DriverParams make_driver_params(const RobotSpec& spec);
SimulationParams make_simulation_params(const Scenario& scenario, std::uint64_t seed);

/// Runs a scenario on virtual time. Same scenario and seed, same run, whatever the number of workers.
/// Errors: robots that overlap or start in a wall, an agent that cannot be started.
Result<RunOutcome> rehearse(const Scenario& scenario, std::shared_ptr<const World> world,
                            const RunParams& params);

}  // namespace adit::sim
