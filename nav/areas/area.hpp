// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "core/result/result.hpp"

namespace adit::nav {

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

/// Checks an area and returns it with its corners counter-clockwise. Two corners are opposite ones of a
/// rectangle with sides along the axes. Error: bad_argument for a name that is not valid, numbers that are
/// not finite or too large, a number of corners outside [2, 16], sides that touch or cross, and nothing
/// enclosed.
Result<Area> checked(Area area);

}  // namespace adit::nav
