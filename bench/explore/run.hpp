// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "sim/rehearsal/rehearsal.hpp"

namespace adit::bench {

/// An exploration to be rehearsed by one robot.
struct ExploreCourse {
  std::string world{};  ///< `blocks2` to `blocks9`, a kind of generated world, or `geb079`.
  std::string platform{};
  std::uint64_t seed{};           ///< Draws start, heading and boxes; 0: those of TARE.
  double noise{0};                ///< Scale of the errors of odometry and sensors.
  std::string perception{"off"};  ///< `off`, `odometry` or `slam`.
  double limit{};                 ///< The run ends after so long, s.
};

/// What an exploration achieved. Times count from the request to explore, s.
struct ExploreOutcome {
  sim::ExplorationResult truth{};
  std::optional<double> done{};  ///< When the robot reported `done`.
  double span{};                 ///< Until 99 % were seen, else until the end; what follows is of this time.
  double mean_speed{};           ///< m/s
  double moving{};               ///< Share of the time at more than 0.1 m/s, [0, 1].
  int reversals{};               ///< Turns by more than 120 degrees within 2 m of the way.
  int collisions{};
};

/// Reason::bad_argument for a world or platform that does not exist.
Result<sim::Scenario> scenario_of(const ExploreCourse& course);
/// Rehearses it until the robot ends its exploration. `trajectory`: file for "time x y yaw" lines; empty:
/// none.
Result<ExploreOutcome> run(const ExploreCourse& course, const sim::AgentFactory& agents,
                           const std::string& trajectory);

}  // namespace adit::bench
