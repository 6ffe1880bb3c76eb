// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cmath>

#include "core/geometry/pose.hpp"

namespace adit::nav {

/// A pose in the plane with its cosine and sine, which Pose2 computes again for each point that it
/// transforms. Its points are equal to those of Pose2 bit by bit.
class PlanarTransform {
 public:
  explicit PlanarTransform(const Pose2& pose)
      : x_(pose.x), y_(pose.y), cos_(std::cos(pose.yaw)), sin_(std::sin(pose.yaw)) {}

  /// Transforms a point from the pose's frame to the frame in which the pose is given, m.
  Eigen::Vector2d operator*(const Eigen::Vector2d& p) const {
    return {x_ + cos_ * p.x() - sin_ * p.y(), y_ + sin_ * p.x() + cos_ * p.y()};
  }

 private:
  double x_, y_, cos_, sin_;
};

}  // namespace adit::nav
