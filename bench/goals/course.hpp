// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "sim/rehearsal/scenario.hpp"
#include "sim/world/generate.hpp"

namespace adit::bench {

/// One robot, one goal in a generated world.
struct Course {
  std::string kind{}, platform{};
  std::uint64_t seed{};
  Eigen::Vector2d start{0, 0}, goal{0, 0};  ///< World frame, m.
  double straight{};                        ///< Straight line from start to goal, m.
  double way{};                             ///< Shortest free way over the 4-neighbours of a grid, m.
  double speed{1.0};                        ///< Top speed of the platform, m/s.
  bool reachable{};                         ///< For a disc as wide as the platform.
};

/// Draws a goal 4 to 25 m from the start, on ground the platform can stand on with 0.1 m beside it; every
/// tenth where it cannot get to, when the world has such a place. Errors of generate_world and of the
/// platform's file.
Result<Course> draw_course(const std::string& kind, const std::string& platform, std::uint64_t seed);

/// The rehearsal of a course, as a scenario's file has it: full lidar, noisy odometry; as long as `slowness`
/// drives of the whole way at half the platform's speed, and half a minute.
std::string scenario_text(const Course& course, double slowness, bool planar);
/// The same, read. Errors of the scenario.
Result<sim::Scenario> scenario_of(const Course& course, double slowness, bool planar);

}  // namespace adit::bench
