// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace adit::nav {

/// What came of a search.
enum class RouteStatus : std::uint8_t {
  found,
  unreachable,    ///< proven: what can be reached, unknown space included, does not hold the goal
  start_blocked,  ///< nothing is passable near the start: nothing is proven
  too_far,        ///< the search would need more than its memory
};

/// Whether a body can stand at a place.
enum class Standing : std::uint8_t {
  standable,      ///< The footprint fits on known ground at one heading or more.
  occupied,       ///< An obstacle stands there, or on one side too near.
  no_floor,       ///< The ground is missing.
  too_steep,      ///< The ground is too steep, or a step.
  too_narrow,     ///< Obstacles on opposite sides of the place leave no heading.
  unseen,         ///< Not known: part of the ground was not seen.
  not_connected,  ///< No route leads there.
};
/// Whether it is known that the body cannot stand there.
constexpr bool is_refused(Standing standing) {
  return standing != Standing::standable && standing != Standing::unseen;
}

/// A way on the ground from one place to another. Frame: that of the map, m.
struct Route {
  RouteStatus status{RouteStatus::unreachable};
  std::vector<Eigen::Vector3d> points{};  ///< corners, from the start to the goal; empty unless found
  std::vector<std::uint8_t> unknown{};  ///< one per leg (points - 1): whether it leads through unknown space
  bool doubtful{false};      ///< over what may be steps, seen from afar only: to be looked at, not relied on
  double length{0};          ///< m
  double unknown_length{0};  ///< of it through unknown space, m
  double cost{0};            ///< m, with what narrow and unknown places cost more

  Standing goal{Standing::standable};  ///< Of the goal, where that was asked for.

  bool found() const { return status == RouteStatus::found; }
  bool attempt() const { return unknown_length > 0.0; }
};

}  // namespace adit::nav
