// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "basestation/gui/scene/camera.hpp"

namespace adit::gui {

/// A point of the map frame, m, z up.
struct Point3 {
  double x{}, y{}, z{};
  bool operator==(const Point3&) const = default;
};

inline Point3 operator+(const Point3& a, const Point3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Point3 operator-(const Point3& a, const Point3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Point3 operator*(double s, const Point3& a) { return {s * a.x, s * a.y, s * a.z}; }
inline double dot(const Point3& a, const Point3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

/// A point of the map on the screen: pixels, and its distance along the line of sight, m.
struct Projected {
  Point at{};
  double depth{};
};

/// The view of a map from outside, which turns around a point of it.
struct OrbitCamera {
  static constexpr double kNear = 0.1;                         ///< Nothing nearer is drawn, m.
  static constexpr double kMinPitch = 0.05, kMaxPitch = 1.57;  ///< In rad; the last one looks straight down.
  static constexpr double kMinDistance = 0.5, kMaxDistance = 5000.0;    ///< m
  static constexpr double kHalfView = 25.0 * std::numbers::pi / 180.0;  ///< Half of the vertical view, rad.

  Point3 target{};  ///< In the middle of the view.
  /// Direction in which the camera looks, from x, rad: nearly north, so that walls along x and y both show.
  double yaw{std::numbers::pi / 2 + 0.22};
  double pitch{0.9};           ///< How far down it looks, rad.
  double distance{20.0};       ///< From the target, m.
  double width{1}, height{1};  ///< Size of the view, pixels.
  bool operator==(const OrbitCamera&) const = default;

  /// The camera's axes in the map frame: right, down and ahead.
  std::array<Point3, 3> axes() const {
    const double cy = std::cos(yaw), sy = std::sin(yaw), cp = std::cos(pitch), sp = std::sin(pitch);
    return {Point3{sy, -cy, 0}, Point3{-sp * cy, -sp * sy, -cp}, Point3{cp * cy, cp * sy, -sp}};
  }
  Point3 eye() const { return target - distance * axes()[2]; }
  double focal() const { return height / 2 / std::tan(kHalfView); }  ///< Pixels.

  /// Nothing: it is behind the camera.
  std::optional<Projected> project(const Point3& point) const {
    const auto [right, down, ahead] = axes();
    const Point3 from_eye = point - eye();
    const double depth = dot(from_eye, ahead);
    if (!(depth > kNear)) return std::nullopt;
    const double scale = focal() / depth;
    return Projected{{width / 2 + dot(from_eye, right) * scale, height / 2 + dot(from_eye, down) * scale},
                     depth};
  }
  /// The place of the map at a pixel and a depth, m.
  Point3 to_map(double x, double y, double depth) const {
    const auto [right, down, ahead] = axes();
    return eye() + depth * ahead + ((x - width / 2) * depth / focal()) * right +
           ((y - height / 2) * depth / focal()) * down;
  }
  void orbit(double dx, double dy) {
    constexpr double kPerPixel = 0.006;  // rad
    yaw = std::remainder(yaw - dx * kPerPixel, 2.0 * std::numbers::pi);
    pitch = std::clamp(pitch + dy * kPerPixel, kMinPitch, kMaxPitch);
  }
  /// Moves the target over the ground, so that it follows the finger.
  void pan(double dx, double dy) {
    const double per_pixel = distance / focal();
    const double c = std::cos(yaw), s = std::sin(yaw);
    const double right = -dx * per_pixel, ahead = dy * per_pixel / std::max(std::sin(pitch), 0.2);
    target.x += right * s + ahead * c;
    target.y += -right * c + ahead * s;
  }
  void zoom(double factor) { distance = std::clamp(distance / factor, kMinDistance, kMaxDistance); }
};

}  // namespace adit::gui
