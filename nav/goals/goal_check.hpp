// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "core/config/traversability.hpp"
#include "nav/footprint.hpp"
#include "nav/route/route_planner.hpp"

namespace adit::nav {

/// What a goal is to a body.
struct GoalFinding {
  Standing standing{Standing::unseen};
  Eigen::Vector3d place{0, 0, 0};     ///< The goal, or the valid place nearest to it, m.
  std::optional<double> moved{};      ///< From the goal to that place, m; nothing: it is the goal.
  double length{}, unknown_length{};  ///< Of the route there, and of its part through unknown space, m.
};

/// Judges on the router's map whether a body can stand at a place: the footprint at one of 16 headings or
/// more must lie on known ground that is free, not too steep and without steps. The footprint is smaller than
/// the body by half a cell on each side, the error of an obstacle's place in the map. Of what flies every
/// place is `unseen`.
class GoalCheck {
 public:
  static constexpr int kHeadings = 16;
  static constexpr double kNearest = 3.0;  ///< The farthest place that replaces a goal, m.

  explicit GoalCheck(const Platform& platform);

  /// `place`: m; z NaN: the floor nearest to `floor`.
  Standing stand(const RoutePlanner& planner, const Eigen::Vector3d& place, double floor) const;
  /// The nearest place within kNearest where the body stands; on known ground only.
  std::optional<Eigen::Vector3d> nearest(const RoutePlanner& planner, const Eigen::Vector3d& place,
                                         double floor) const;
  /// Judges a goal and the route to it; `replace`: by the nearest valid place where it is none.
  GoalFinding check(RoutePlanner& planner, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                    bool replace) const;

 private:
  /// What is found under the footprint at one heading.
  struct Ground;
  Ground under(const SurfaceMap& map, const Eigen::Vector3d& place, double yaw) const;
  /// Whether a place is free itself, and obstacles lie on two opposite sides of it within the body's reach.
  bool is_between(const SurfaceMap& map, const Eigen::Vector3d& place) const;

  Footprint body_;
  Traversability limits_;
  bool flies_;
};

}  // namespace adit::nav
