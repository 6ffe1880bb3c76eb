// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <limits>
#include <vector>

#include "nav/route/route.hpp"
#include "nav/route/surface_map.hpp"
#include "nav/route/tile_builder.hpp"

namespace adit::nav {

/// What a straight line over the ground costs.
struct LineCost {
  bool passable{false};
  double cost{0};     ///< m, as of a route
  double unknown{0};  ///< of its length, m
};

/// A robot may stand, and a goal lie, nearer to something than a way leads: an end of a line that is let out
/// or in may be too narrow for half a metre, as long as nothing stands there.
struct LineEnds {
  bool let_out{false}, let_in{false};
  double most{std::numeric_limits<double>::infinity()};  ///< what costs more is not followed to its end, m
};

/// Walks lines over the map's ground, and shortens ways with them.
class RouteLine {
 public:
  RouteLine(SurfaceMap& map, TileBuilder& builder) : map_(map), builder_(builder) {}

  /// From one point of the ground to another, both within 1.2 m of it; not passable where the ground is
  /// not, where a step is, where the floor does not lead to `to`'s height, or where it costs too much.
  LineCost line(const Eigen::Vector3d& from, const Eigen::Vector3d& to, LineEnds ends = {});
  /// Replaces parts of a way by straight lines, where those are passable and cost no more. Each leg of
  /// `points` must be passable.
  void shorten(std::vector<Eigen::Vector3d>& points);
  /// Fills in lengths, unknown legs and cost of all legs. False when one of them is not passable.
  bool measure(Route& route);

 private:
  void shorten_once(std::vector<Eigen::Vector3d>& points);

  SurfaceMap& map_;
  TileBuilder& builder_;
};

}  // namespace adit::nav
