// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "core/config/traversability.hpp"
#include "nav/geometry/footprint.hpp"
#include "nav/routing/route_planner.hpp"

namespace adit::nav {

/// Result of a goal check.
struct GoalFinding {
  Standing standing{Standing::unseen};
  Eigen::Vector3d place{0, 0, 0};     ///< The goal, or the nearest valid place, m.
  std::optional<double> moved{};      ///< Distance from the goal to that place, m; nothing: it is the goal.
  std::optional<Staircase> stairs{};  ///< Of `over_stairs`.
  double length{}, unknown_length{};  ///< Of the route there, and of its part through unknown space, m.
};

/// Checks on the global planner's map whether a body can stand at a place: at one of at least 16 headings the
/// footprint must lie on known ground that is free, not too steep and without steps. The footprint is reduced
/// by half a cell on each side, the position error of an obstacle in the map. For a flying robot every place
/// is `unseen`.
class GoalCheck {
 public:
  static constexpr int kHeadings = 16;
  static constexpr double kNearest = 3.0;  ///< Maximum distance of a replacement from the goal, m.

  explicit GoalCheck(const Platform& platform);
  /// Sets the areas that a goal must lie in or out of, in the planner's frame.
  void set_areas(const AreaSet& areas) { areas_ = areas; }

  /// Checks `place`, m; z NaN: the floor nearest to `floor`.
  Standing stand(const RoutePlanner& planner, const Eigen::Vector3d& place, double floor) const;
  /// The nearest place within kNearest where the body can stand, on known ground only. Searches in rings of
  /// 0.25 m, the nearest one first. Takes its checks of the footprint off `checks`, and ends with nothing
  /// when none is left.
  std::optional<Eigen::Vector3d> nearest(const RoutePlanner& planner, const Eigen::Vector3d& place,
                                         double floor, int& checks) const;
  /// Checks a goal and the route to it. `replace`: replaces an invalid goal by the nearest valid place, for
  /// at most `checks` of the footprint; without a place within those the goal keeps its reason.
  GoalFinding check(RoutePlanner& planner, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                    bool replace, int checks) const;
  GoalFinding check(RoutePlanner& planner, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                    bool replace) const {
    return check(planner, from, to, replace, budget());
  }
  /// Number of checks of the footprint that take 25 ms on an idle core, so that the answer comes within 100
  /// ms on a loaded one.
  int budget() const;

 private:
  /// What lies under the footprint at one heading.
  struct Ground;
  Ground under(const SurfaceMap& map, const Eigen::Vector3d& place, double yaw) const;
  int headings() const { return body_.symmetric() ? kHeadings / 2 : kHeadings; }
  /// Half the side of the square of cells around the footprint.
  int cells_around() const { return static_cast<int>(body_.radius() / kRouteCell) + 1; }
  /// Whether what the footprint covers at every heading rules the place out.
  bool never_stands(const SurfaceMap& map, const Eigen::Vector3d& place) const;
  /// Whether stand() is `standable`; takes its checks of the footprint off `checks`.
  bool stands(const RoutePlanner& planner, const Eigen::Vector3d& place, double floor, int& checks) const;
  /// Whether a place itself is free, but obstacles lie on two opposite sides of it within the body's reach.
  bool is_between(const SurfaceMap& map, const Eigen::Vector3d& place) const;

  Footprint body_;
  double always_covered_;  ///< Radius of the circle that the footprint covers at every heading, m.
  Traversability limits_;
  AreaSet areas_{};
  double reach_;  ///< Least distance of a goal from forbidden ground, m.
  bool flies_;
};

}  // namespace adit::nav
