// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/geometry/pose.hpp"
#include "sim/world/noise.hpp"

namespace adit::sim {

inline constexpr double kMountOffset = 0.01;  // m: largest error of a sensor's place
inline constexpr double kMountAngle = 0.3;    // degrees: largest error of its axes

/// How far a sensor sits from where its file says: at most `offset` m away, turned about any axis by at most
/// `angle` degrees.
inline Pose3 mount_error(Random& random, double offset, double angle) {
  Eigen::Vector3d place, axis;
  constexpr double kAxisShare = 0.57735;  // 1 / sqrt(3)
  for (double& v : place) v = random.uniform(-offset, offset) * kAxisShare;
  for (double& v : axis) v = gaussian(random);
  const double turn = random.uniform(-angle, angle) * M_PI / 180.0;
  const double norm = axis.norm();
  const Eigen::Vector3d about = norm > 0.0 ? Eigen::Vector3d(axis / norm) : Eigen::Vector3d::UnitZ();
  return {place, Eigen::Quaterniond(Eigen::AngleAxisd(turn, about))};
}

}  // namespace adit::sim
