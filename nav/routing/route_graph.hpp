// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "nav/routing/route_line.hpp"
#include "nav/routing/route_search.hpp"

namespace adit::nav {

/// Route queries over the graph of a map.
class RouteGraph {
 public:
  RouteGraph(SurfaceMap& map, const Platform& platform, const RouteParams& params);
  RouteGraph(const RouteGraph&) = delete;
  RouteGraph& operator=(const RouteGraph&) = delete;

  /// See RoutePlanner.
  Route plan(const Eigen::Vector3d& from, const Eigen::Vector3d& to);
  std::vector<float> costs(const Eigen::Vector3d& from, std::span<const Eigen::Vector3d> goals);
  std::optional<double> ground(double x, double y, double z) const;
  TileBuilder& builder() { return builder_; }
  RouteLine& line() { return line_; }
  const RouteSearch& search() const { return search_; }

 private:
  bool is_blocked_between(const Eigen::Vector3d& place, int ix, int iy) const;
  std::optional<RouteEnd> find_end(const Eigen::Vector3d& place, double reach);
  double goal_height(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const;
  void finish_ends(Route& route, const Eigen::Vector3d& from, const Eigen::Vector3d& to) const;

  RouteParams params_;
  SurfaceMap& map_;
  TileBuilder builder_;
  RouteLine line_;
  RouteSearch search_;
};

}  // namespace adit::nav
