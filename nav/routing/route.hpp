// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/geometry/staircase.hpp"

namespace adit::nav {

/// Result of a route search.
enum class RouteStatus : std::uint8_t {
  found,
  unreachable,    ///< Proven: the goal is not in the reachable space, unknown space included.
  start_blocked,  ///< No cell near the start is passable; nothing is proven.
  too_far,        ///< The search exceeded its memory, and no route leads through what it could hold.
};

/// Whether a body can stand at a place.
enum class Standing : std::uint8_t {
  standable,      ///< The footprint fits on known ground at one heading at least.
  occupied,       ///< An obstacle is there, or too near on one side.
  no_floor,       ///< The ground is missing.
  too_steep,      ///< The ground is too steep, or has a step.
  too_narrow,     ///< Obstacles on opposite sides leave no heading free.
  unseen,         ///< Part of the ground has not been seen.
  not_connected,  ///< No route leads there.
  over_stairs,    ///< A known staircase leads there that the body does not climb, and no other route.
  forbidden,      ///< The robot's areas do not permit it.
};
/// Whether the body is known not to fit there.
constexpr bool is_refused(Standing standing) {
  return standing != Standing::standable && standing != Standing::unseen;
}

/// A path on the ground between two places. Map frame, m.
struct Route {
  RouteStatus status{RouteStatus::unreachable};
  std::vector<Eigen::Vector3d> points{};  ///< Corners from the start to the goal; empty unless found.
  /// One per leg (points - 1): whether the leg leads through unknown space.
  std::vector<std::uint8_t> unknown{};
  double length{0};          ///< m
  double unknown_length{0};  ///< Length of its part through unknown space, m.
  double cost{0};            ///< Length with the penalties of narrow and unknown places, m.

  Standing goal{Standing::standable};  ///< Of the goal, if it was checked.
  /// Unreachable: a known staircase that leads towards the goal, and that the body does not climb.
  std::optional<Staircase> stairs{};

  bool found() const { return status == RouteStatus::found; }
};

/// The first `length` metres of a line through points. Frame and unit of the points.
std::vector<Eigen::Vector3d> first_part(std::span<const Eigen::Vector3d> points, double length);

}  // namespace adit::nav
