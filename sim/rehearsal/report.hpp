// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/result/result.hpp"
#include "sim/checker/checker.hpp"
#include "sim/truth/exploration_record.hpp"
#include "sim/truth/map_truth.hpp"

namespace adit::sim {

struct ExpectationResult {
  std::string text{};  ///< As written in the scenario.
  int line{};
  bool ok{};
  std::string found{};  ///< What was found instead, as text; empty when ok.
};

struct RuleResult {
  int number{};
  std::string title{};
  std::uint64_t violations{};
  std::vector<Violation> first{};  ///< The first ones.
};

struct RobotResult {
  double distance{};       ///< True distance driven, m.
  int collisions{};        ///< Contacts that began.
  int caused{};            ///< Those caused by the robot (sim/world/simulation.hpp, Collision).
  double min_clearance{};  ///< Smallest clearance of the run, m.
  double moving{};         ///< Share of the time in motion, [0, 1].
  std::map<std::string, double> mode_seconds{};

  /// "clearance 0.20 m", or that nothing was near.
  std::string clearance() const;
};

struct TopicResult {
  std::uint64_t samples{};
  std::uint64_t bytes{};  ///< Payload written, bytes.
  std::uint64_t delivered{};
};

struct CommandResult {
  std::uint64_t sent{}, accepted{}, refused{};
  std::map<std::string, std::uint64_t> reasons{};  ///< Refusals by reason.
};

/// The map that reached the stations.
struct MapResult {
  std::uint64_t bytes{};                 ///< Payload of pieces and their acknowledgements written.
  double m2{};                           ///< Ground in the map of the station that has most.
  std::optional<MapJudgement> judged{};  ///< Of a scenario that judges_maps().
  std::string by{};  ///< Operator whose map was judged: the first, by name, whose station has a map.

  double bytes_per_m2() const { return m2 > 0.0 ? static_cast<double>(bytes) / m2 : 0.0; }
};

/// An event on the time line: for the picture and for people.
struct TimedEvent {
  Duration at{};
  std::string robot{};
  std::string text{};
};

/// Files with a robot's poses, one "time x y z qx qy qz qw" a line (TUM format), s and m.
struct TrajectoryFiles {
  std::string truth{};     ///< World frame.
  std::string odometry{};  ///< Frame `odom`, which begins at the start pose.
  std::string map{};       ///< The robot's own estimate, map frame, as it states it.
};

/// What one run gave.
struct RunReport {
  std::string scenario{};
  std::uint64_t seed{};
  std::string digest{};
  double virtual_s{}, wall_s{};
  std::vector<ExpectationResult> expectations{};
  std::vector<RuleResult> rules{};
  std::map<std::string, RobotResult> robots{};
  std::optional<ExplorationResult> exploration{};         ///< Of a scenario that explores().
  std::optional<MapResult> map{};                         ///< Of a scenario with `perception: slam`.
  std::map<std::string, TrajectoryFiles> trajectories{};  ///< By robot; empty unless they were asked for.
  std::map<std::string, TopicResult, std::less<>> topics{};
  CommandResult commands{};
  std::map<std::string, std::uint64_t> faults{};  ///< Executed faults by kind.
  std::vector<TimedEvent> events{};
  std::uint64_t failures{};  ///< Exceptions that left a task.

  std::uint64_t fault_count() const;
  bool ok() const;
  /// One line for each thing that failed.
  std::vector<std::string> complaints() const;
};

/// The report as one JSON object (docs/rehearsal.md).
std::string to_json(const RunReport& report);
/// Writes it. Reason::cannot_write names the file.
Result<void> write_json(const RunReport& report, const std::string& file);

}  // namespace adit::sim
