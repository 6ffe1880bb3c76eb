// SPDX-License-Identifier: Apache-2.0
#include "sim/world/solid_path.hpp"

#include <algorithm>

namespace adit::sim {
namespace {

constexpr double kNever = VoxelGrid::kNoHit;

/// One axis of columns: where the way is on it, and when it crosses the next border.
struct Axis {
  int cell{};
  int step{};
  double next{kNever};  // m along the way
  double stride{kNever};

  Axis(double start, double speed, double origin, double resolution, int first) : cell(first) {
    if (speed == 0.0) return;
    step = speed > 0.0 ? 1 : -1;
    next = (origin + (first + (step > 0 ? 1 : 0)) * resolution - start) / speed;
    stride = resolution / std::abs(speed);
  }
  void advance() { cell += step, next += stride; }
};

}  // namespace

double solid_between(const VoxelGrid& grid, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                     double max_length) {
  const double length = (b - a).norm();
  if (!(length > 0.0) || !std::isfinite(length)) return 0.0;
  const Eigen::Vector3d way = (b - a) / length;
  const double resolution = grid.resolution();
  Axis x(a.x(), way.x(), grid.origin().x(), resolution, grid.column_x(a.x()));
  Axis y(a.y(), way.y(), grid.origin().y(), resolution, grid.column_y(a.y()));
  const std::vector<double>& levels = grid.levels();
  // -1: below the grid, layers(): above it.
  int k = static_cast<int>(std::upper_bound(levels.begin(), levels.end(), a.z()) - levels.begin()) - 1;
  const auto next_z = [&] {
    const int border = way.z() > 0.0 ? k + 1 : k;
    if (way.z() == 0.0 || border < 0 || border > grid.layers()) return kNever;
    return (levels[static_cast<std::size_t>(border)] - a.z()) / way.z();
  };
  double z = next_z();
  double at = 0.0, sum = 0.0;
  while (at < length && sum <= max_length) {
    const double next = std::max(at, std::min({x.next, y.next, z, length}));
    const bool within = k >= 0 && k < grid.layers();
    const bool solid =
        !within || (grid.inside(x.cell, y.cell) ? grid.solid(x.cell, y.cell, k) : !grid.open_sides());
    if (solid) sum += next - at;
    at = next;
    if (x.next <= at) x.advance();
    if (y.next <= at) y.advance();
    if (z <= at) {
      k += way.z() > 0.0 ? 1 : -1;
      z = next_z();
    }
  }
  return sum;
}

}  // namespace adit::sim
