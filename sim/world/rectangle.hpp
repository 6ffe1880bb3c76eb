// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>

#include "core/geometry/pose.hpp"

namespace adit::sim {

/// A rectangle on the ground: a footprint, or a cell. Metres.
struct Rectangle {
  Pose2 pose{};     ///< Pose of its centre.
  double length{};  ///< Extent along its x, m.
  double width{};   ///< Extent along its y, m.

  std::array<Eigen::Vector2d, 4> corners() const;
  /// Distance from its centre to a corner.
  double radius() const { return 0.5 * std::hypot(length, width); }
};

/// Whether two rectangles share more than their border: separating axes.
bool overlap(const Rectangle& a, const Rectangle& b);
/// How far apart two rectangles are along the axis, of their sides' four, that separates them most, m;
/// negative when they overlap: how deep. Never more than distance().
double separation(const Rectangle& a, const Rectangle& b);
/// Shortest distance between two rectangles, m; 0 when they overlap.
double distance(const Rectangle& a, const Rectangle& b);

}  // namespace adit::sim
