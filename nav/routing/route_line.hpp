// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <limits>
#include <vector>

#include "nav/routing/route.hpp"
#include "nav/routing/surface_map.hpp"
#include "nav/routing/tile_builder.hpp"

namespace adit::nav {

/// Cost of a straight line over the ground.
struct LineCost {
  bool passable{false};
  double cost{0};     ///< As for a route, m.
  double unknown{0};  ///< Length in unknown space, m.
};

/// Relaxation at the ends of a line: a robot or goal may be closer to obstacles than a route permits, so half
/// a metre at an end may be too narrow, as long as its cells are free.
struct LineEnds {
  bool relax_start{false}, relax_end{false};
  double most{std::numeric_limits<double>::infinity()};  ///< The evaluation stops at this cost, m.
};

/// Evaluates straight lines over the map's ground and shortens routes with them.
class RouteLine {
 public:
  RouteLine(SurfaceMap& map, TileBuilder& builder) : map_(map), builder_(builder) {}

  /// Evaluates the line between two points within 1.2 m of the ground. It is not passable across impassable
  /// cells or steps, if the floor does not lead to the height of `to`, or if it costs too much.
  LineCost line(const Eigen::Vector3d& from, const Eigen::Vector3d& to, LineEnds ends = {});
  /// Replaces parts of a route by straight lines that are passable and cost no more. Each leg of `points`
  /// must be passable.
  void shorten(std::vector<Eigen::Vector3d>& points);
  /// Computes lengths, unknown legs and cost of a route. False if a leg is not passable.
  bool measure(Route& route);

 private:
  void shorten_once(std::vector<Eigen::Vector3d>& points);

  SurfaceMap& map_;
  TileBuilder& builder_;
};

}  // namespace adit::nav
