// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

namespace adit::nav {

/// The "diamond angle": a bearing without trigonometry, monotone in the angle, [-1, 3) from -y over +x back
/// to -y.
inline float diamond_angle(float dx, float dy) {
  const float t = dy / (std::fabs(dx) + std::fabs(dy));  // [-1, 1]
  return dx < 0 ? 2.0f - t : t;
}

/// Direction and range of a return from its sensor.
struct Ray {
  float range{};    ///< Horizontal distance, m.
  float tangent{};  ///< Tangent of the elevation.
  float bearing{};  ///< Diamond angle.

  static Ray to(float dx, float dy, float dz) {
    const float range = std::sqrt(dx * dx + dy * dy);
    return {range, dz / range, diamond_angle(dx, dy)};
  }
};

/// Rays to a block of points. The loops run for every return of a scan and are written so that the compiler
/// vectorises them, four rays at a time.
class RayBlock {
 public:
  static constexpr std::size_t kSize = 128;

  /// Computes the rays to as many points as fit in, from a sensor at `lidar` in axes rotated by `turn`.
  /// Points that are not finite give rays that are not finite.
  void take(std::span<const Eigen::Vector3f> points, const Eigen::Vector3f& lidar,
            const Eigen::Matrix3f& turn) {
    count_ = points.size() < kSize ? points.size() : kSize;
    const float x0 = lidar.x(), y0 = lidar.y(), z0 = lidar.z();
    for (std::size_t n = 0; n < count_; ++n) {
      x_[n] = points[n].x() - x0;
      y_[n] = points[n].y() - y0;
      z_[n] = points[n].z() - z0;
    }
    const float a = turn(0, 0), b = turn(0, 1), c = turn(0, 2), d = turn(1, 0), e = turn(1, 1),
                f = turn(1, 2), g = turn(2, 0), h = turn(2, 1), i = turn(2, 2);
    for (std::size_t n = 0; n < kSize; ++n) {
      const float dx = a * x_[n] + b * y_[n] + c * z_[n];
      const float dy = d * x_[n] + e * y_[n] + f * z_[n];
      const float dz = g * x_[n] + h * y_[n] + i * z_[n];
      const float range = std::sqrt(dx * dx + dy * dy);
      range_[n] = range;
      tangent_[n] = dz / range;
      bearing_[n] = diamond_angle(dx, dy);
    }
  }
  std::size_t count() const { return count_; }
  /// Those from count() on, below kSize, have no meaning, and are there for loops that the compiler
  /// vectorises.
  Ray operator[](std::size_t n) const { return {range_[n], tangent_[n], bearing_[n]}; }
  /// Height of a point above the sensor, in the axes of the points, m.
  float height(std::size_t n) const { return z_[n]; }

 private:
  std::size_t count_{0};
  std::array<float, kSize> x_{}, y_{}, z_{}, range_{}, tangent_{}, bearing_{};
};

}  // namespace adit::nav
