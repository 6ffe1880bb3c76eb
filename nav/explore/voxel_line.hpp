// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <cmath>
#include <limits>

#include "core/geometry/round_down.hpp"
#include "nav/explore/coverage_map.hpp"

namespace adit::nav {

/// CoverageMap::voxel_at() without calls of std::floor, as it runs for every ray.
inline CoverageVoxel voxel_around(const Eigen::Vector3d& place) {
  return {round_down(place.x() / CoverageMap::kVoxel), round_down(place.y() / CoverageMap::kVoxel),
          round_down(place.z() / CoverageMap::kVoxel)};
}

/// Visits the voxels along a line from its begin to its end, both included (Amanatides and Woo: *A fast voxel
/// traversal algorithm for ray tracing*, 1987).
/// `visit(voxel, last)`: returns false to end; `last`: the voxel holds the end of the line.
template <class Visit>
void walk_voxels(const Eigen::Vector3d& from, const Eigen::Vector3d& to, Visit&& visit) {
  const CoverageVoxel first = voxel_around(from), end = voxel_around(to);
  std::array<int, 3> at{first.x, first.y, first.z};
  const std::array<int, 3> goal{end.x, end.y, end.z};
  std::array<int, 3> step{};
  std::array<double, 3> next{}, stride{};
  int left = 0;
  for (int n = 0; n < 3; ++n) {
    const auto i = static_cast<std::size_t>(n);
    const double way = to[n] - from[n];
    left += std::abs(goal[i] - at[i]);
    step[i] = way > 0 ? 1 : -1;
    stride[i] = way != 0.0 ? CoverageMap::kVoxel / std::abs(way) : std::numeric_limits<double>::infinity();
    const double border = CoverageMap::kVoxel * (at[i] + (way > 0 ? 1 : 0));
    next[i] = way != 0.0 ? (border - from[n]) / way : std::numeric_limits<double>::infinity();
  }
  for (;; --left) {
    if (!visit(CoverageVoxel{at[0], at[1], at[2]}, left <= 0) || left <= 0) return;
    const std::size_t n = next[0] < next[1] ? (next[0] < next[2] ? 0 : 2) : (next[1] < next[2] ? 1 : 2);
    at[n] += step[n];
    next[n] += stride[n];
  }
}

}  // namespace adit::nav
