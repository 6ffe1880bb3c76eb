// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cmath>

#include "sim/world/lidar.hpp"

namespace adit::sim {

/// A box in its own frame, with the sensor's position there.
struct BoxTarget {
  Eigen::Vector2d axis;     ///< Cosine and sine of its yaw in the world.
  Eigen::Vector3d centre;   ///< World, m.
  Eigen::Vector3d start;    ///< Where the beams start, box frame, m.
  Eigen::Vector3d half;     ///< Half its edges, m.
  Eigen::Vector2d towards;  ///< Unit vector from the sensor, world.
  double cos_spread;        ///< Cosine of the half angle that the box fills, seen from above.

  /// Moves the start of the beams (world, m).
  void set_start(const Eigen::Vector3d& sensor) {
    const Eigen::Vector3d away = sensor - centre;
    start = {axis.x() * away.x() + axis.y() * away.y(), axis.x() * away.y() - axis.y() * away.x(), away.z()};
  }
};

inline BoxTarget make_target(const BodyBox& body, const Eigen::Vector3d& sensor) {
  BoxTarget target{};
  target.axis = {std::cos(body.pose.yaw), std::sin(body.pose.yaw)};
  const Eigen::Vector2d away(sensor.x() - body.pose.x, sensor.y() - body.pose.y);
  target.half = 0.5 * Eigen::Vector3d(body.length, body.width, body.height);
  target.centre = {body.pose.x, body.pose.y, body.ground + target.half.z()};
  target.set_start(sensor);
  const double distance = away.norm(), radius = target.half.head<2>().norm();
  target.cos_spread = distance > radius ? std::sqrt(1.0 - radius * radius / (distance * distance)) : -1.0;
  target.towards = distance > 0.0 ? Eigen::Vector2d(-away / distance) : Eigen::Vector2d(1.0, 0.0);
  return target;
}

/// Distance to the box by slabs (Kay and Kajiya, 1986); no_hit when missed or when the beam starts inside.
inline double cast_box(const BoxTarget& target, const Eigen::Vector3d& direction) {
  const Eigen::Vector3d d(target.axis.x() * direction.x() + target.axis.y() * direction.y(),
                          target.axis.x() * direction.y() - target.axis.y() * direction.x(), direction.z());
  double enter = 0.0, leave = VoxelGrid::kNoHit;
  for (int n = 0; n < 3; ++n) {
    if (d[n] == 0.0) {
      if (std::abs(target.start[n]) > target.half[n]) return VoxelGrid::kNoHit;
      continue;
    }
    const double a = (-target.half[n] - target.start[n]) / d[n],
                 b = (target.half[n] - target.start[n]) / d[n];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter > 0.0 && enter <= leave ? enter : VoxelGrid::kNoHit;
}

}  // namespace adit::sim
