// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>
#include <span>

#include "perception/objects/object_detector.hpp"

namespace adit::perception {

/// A camera without distortion: it looks along x of its frame, y is left and z up.
struct PinholeView {
  double field_of_view{1.2};  ///< Horizontal, rad, (0, 3).
  double aspect{4.0 / 3.0};   ///< Width by height of the picture.

  /// The share of the picture's width and height at which a point is seen (camera frame, m); nothing: the
  /// point is less than 0.1 m in front of the camera or outside of the picture.
  std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& point) const;
  /// The direction of a place in the picture, with x = 1.
  Eigen::Vector3d ray(double across, double down) const;
};

/// Where an object is, camera frame.
struct ObjectPlace {
  Eigen::Vector3d position{0, 0, 0};  ///< m
  double sigma{};                     ///< Standard deviation of the distance from the true place, m.
  std::size_t points{};               ///< Points of the lidar on the object.
};

/// Measures the distance of an object with the lidar's points in the inner part of its box: the median depth
/// of the nearest cluster, along the ray through the middle of the box. `points`: camera frame, m.
///
/// Nothing where fewer than three points are on it, and where its height in metres is not that of its class.
std::optional<ObjectPlace> place_object(const ObjectBox& box, const PinholeView& view,
                                        std::span<const Eigen::Vector3f> points);

}  // namespace adit::perception
