// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "core/config/platform.hpp"
#include "core/geometry/pose.hpp"

/// What navtool does; each gives the exit status: 0 done, 1 there is no way, 2 something cannot be read.
namespace adit::sim::navtool {

struct RouteOptions {
  std::string map{};  ///< An OctoMap file, or its name on the search path.
  Eigen::Vector3d from{0, 0, 0}, to{0, 0, 0};
  std::string platform{"wheeled"};
  bool json{false};
  std::string picture{};
};
int route(const RouteOptions& options);

struct PlanOptions {
  std::string clouds{};
  Eigen::Vector2d goal{0, 0};
  std::string platform{"wheeled"};
  std::string frame{"auto"};  ///< Frame of the points: `sensor`, `map` or `auto`.
  bool json{false};
  std::string picture{};
};
int plan(const PlanOptions& options);

struct TerrainOptions {
  std::string cloud{};   ///< A file, or a folder whose clouds are accumulated.
  std::string poses{};   ///< Of base_link, one for each cloud, TUM; empty: the robot is stationary.
  std::string sensor{};  ///< File with the `sensors:` part of a platform's; empty: the platform's own.
  std::string platform{"wheeled"};
  double range{20.0};  ///< m, (0, 100]
  bool json{false};
  std::string picture{};
};
int terrain(const TerrainOptions& options);

struct TrackOptions {
  std::string path{};  ///< File of x y pairs; empty: a wave with a corner.
  std::string platform{"wheeled"};
  bool json{false};
  std::string picture{};
};
int track(const TrackOptions& options);

}  // namespace adit::sim::navtool
