// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace adit {

enum class AreaKind : std::uint8_t {
  keep_in,   ///< Robots stay within the union of all areas of this kind.
  keep_out,  ///< Robots stay outside.
  prefer,    ///< What is seen here counts `weight` times for exploration.
};
inline constexpr std::string_view kAreaKinds[]{"keep_in", "keep_out", "prefer"};
constexpr std::string_view name(AreaKind kind) { return kAreaKinds[static_cast<std::size_t>(kind)]; }

/// A named part of the ground: a simple polygon, at any height or between two heights.
struct Area {
  static constexpr std::size_t kMaxCorners = 16;
  static constexpr double kFarthest = 10'000.0;  ///< Largest coordinate, m.
  static constexpr double kMaxWeight = 10.0;
  /// Ground that is lower or higher by this belongs to the area, too, m: heights are not exact.
  static constexpr double kHeightError = 0.3;

  std::string name{};
  AreaKind kind{AreaKind::keep_in};
  std::vector<Eigen::Vector2d> corners{};  ///< In their order, m.
  double z_min{-std::numeric_limits<double>::infinity()};
  double z_max{std::numeric_limits<double>::infinity()};
  double weight{1.0};  ///< Of `prefer`, [0, kMaxWeight].
  bool operator==(const Area&) const = default;

  bool at_height(double z) const { return z >= z_min - kHeightError && z <= z_max + kHeightError; }
  /// Whether a place, m, lies within the polygon, at any height.
  bool contains(const Eigen::Vector2d& place) const;
};

inline bool Area::contains(const Eigen::Vector2d& place) const {
  bool inside = false;
  for (std::size_t i = 0, j = corners.size() - 1; i < corners.size(); j = i++) {
    const Eigen::Vector2d &a = corners[i], &b = corners[j];
    if ((a.y() > place.y()) == (b.y() > place.y())) continue;
    if (place.x() < a.x() + (place.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) inside = !inside;
  }
  return inside;
}

}  // namespace adit
