// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>

#include "nav/planners/plan.hpp"
#include "nav/terrain/obstacle_point.hpp"

namespace adit::nav {

/// Interface of local planners: obstacles and a target in, a path out. `planner` in a platform's YAML file
/// selects one; docs/navigation.md shows how to write another.
class Planner {
 public:
  virtual ~Planner() = default;

  /// Runs one planning cycle. `pose`: the body in the odometry frame at `stamp_s`. `obstacles`: in the
  /// robot's frame at `pose`. A plan never leads through an obstacle of cost 1; when nothing is free, it is
  /// `blocked` and empty. Does not allocate.
  virtual Plan plan(const Target& target, const Pose2& pose, std::span<const ObstaclePoint> obstacles,
                    double stamp_s) = 0;
};

}  // namespace adit::nav
