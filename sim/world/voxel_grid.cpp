#include "sim/world/voxel_grid.hpp"

#include <algorithm>
#include <cmath>

namespace adit::sim {

VoxelGrid::VoxelGrid(const Eigen::Vector2d& origin, double resolution, int nx, int ny,
                     std::vector<double> levels, bool open_sides)
    : origin_(origin),
      resolution_(resolution),
      nx_(nx),
      ny_(ny),
      open_sides_(open_sides),
      levels_(std::move(levels)),
      cells_(static_cast<std::size_t>(nx) * ny * (levels_.size() - 1), 0) {}

void VoxelGrid::build() {
  // Two sweeps with unit weights give the exact Chebyshev distance. What lies beside the grid counts as
  // solid here, so that no stride leaves it.
  constexpr int cap = 255;
  for (int k = 0; k < layers(); ++k) {
    const auto at = [&](int i, int j) -> int { return inside(i, j) ? cells_[index(i, j, k)] : 0; };
    const auto sweep = [&](int i, int j, int side) {
      std::uint8_t& cell = cells_[index(i, j, k)];
      if (cell == 0) return;
      const int near = std::min({at(i - side, j), at(i - 1, j - side), at(i, j - side), at(i + 1, j - side)});
      cell = static_cast<std::uint8_t>(std::min<int>(cell, std::min(cap, near + 1)));
    };
    for (int j = 0; j < ny_; ++j)
      for (int i = 0; i < nx_; ++i)
        if (cells_[index(i, j, k)] != 0) cells_[index(i, j, k)] = cap;
    for (int j = 0; j < ny_; ++j)
      for (int i = 0; i < nx_; ++i) sweep(i, j, 1);
    for (int j = ny_ - 1; j >= 0; --j)
      for (int i = nx_ - 1; i >= 0; --i) sweep(i, j, -1);
  }
}

VoxelGrid::Start VoxelGrid::locate(const Eigen::Vector3d& position) const {
  Start start{position, (position.x() - origin_.x()) / resolution_, (position.y() - origin_.y()) / resolution_,
              0, 0, -1};
  // Far outside the range of int the value is only compared, so it may be clamped.
  start.i = static_cast<int>(std::floor(std::clamp(start.gx, -1e6, 1e6)));
  start.j = static_cast<int>(std::floor(std::clamp(start.gy, -1e6, 1e6)));
  if (position.z() >= levels_.front() && position.z() < levels_.back())
    start.k = static_cast<int>(std::upper_bound(levels_.begin(), levels_.end(), position.z()) -
                               levels_.begin()) - 1;
  return start;
}

double VoxelGrid::cast_beside(const Start& start, const Eigen::Vector3d& direction, double max_range) const {
  if (direction.z() == 0.0) return no_hit;
  const double border = direction.z() > 0.0 ? levels_.back() : levels_.front();
  const double t = (border - start.position.z()) / direction.z();
  return t < max_range ? t : no_hit;
}

bool VoxelGrid::enter(Start& start, const Eigen::Vector3d& direction, double& t) const {
  double first = 0.0, last = no_hit;
  const double g[2] = {start.gx, start.gy};
  const double size[2] = {static_cast<double>(nx_), static_cast<double>(ny_)};
  for (int axis = 0; axis < 2; ++axis) {
    const double speed = direction[axis] / resolution_;
    if (speed == 0.0) {
      if (g[axis] < 0.0 || g[axis] >= size[axis]) return false;
      continue;
    }
    const double a = -g[axis] / speed, b = (size[axis] - g[axis]) / speed;
    first = std::max(first, std::min(a, b));
    last = std::min(last, std::max(a, b));
  }
  if (first >= last) return false;
  const double z = start.position.z() + first * direction.z();
  if (z < levels_.front() || z >= levels_.back()) return false;
  t = first;
  start.i = std::clamp(static_cast<int>(std::floor(start.gx + first * direction.x() / resolution_)), 0, nx_ - 1);
  start.j = std::clamp(static_cast<int>(std::floor(start.gy + first * direction.y() / resolution_)), 0, ny_ - 1);
  start.k = static_cast<int>(std::upper_bound(levels_.begin(), levels_.end(), z) - levels_.begin()) - 1;
  return true;
}

double VoxelGrid::cast(const Start& from, const Eigen::Vector3d& direction, double max_range) const {
  if (from.k < 0) return 0.0;
  Start start = from;
  double t = 0.0;
  if (!inside(start.i, start.j)) {
    if (!open_sides_) return 0.0;
    if (!enter(start, direction, t)) return cast_beside(from, direction, max_range);
    if (t >= max_range) return no_hit;
  }
  // An axis that the ray does not move along gets a border far away instead of a division by zero.
  constexpr double far = 1e30;
  const bool px = direction.x() >= 0.0, py = direction.y() >= 0.0, pz = direction.z() >= 0.0;
  const double sx = direction.x() / resolution_, sy = direction.y() / resolution_;
  const double ax = sx != 0.0 ? 1.0 / sx : far;
  const double ay = sy != 0.0 ? 1.0 / sy : far;
  const double az = direction.z() != 0.0 ? 1.0 / direction.z() : far;
  const double gx = start.gx, gy = start.gy, z = start.position.z();
  const int top = layers();
  const std::uint8_t* const cells = cells_.data();
  const std::size_t row = nx_, slice = static_cast<std::size_t>(nx_) * ny_;
  int i = start.i, j = start.j, k = start.k;
  while (true) {
    const int stride = cells[k * slice + j * row + i];
    if (stride == 0) return t;
    const double tx = ((px ? i + stride : i - stride + 1) - gx) * ax;
    const double ty = ((py ? j + stride : j - stride + 1) - gy) * ay;
    const double tz = (levels_[pz ? k + 1 : k] - z) * az;
    // The two axes that do not cross a border are kept inside the square: rounding cannot lead astray.
    const int i0 = i - stride + 1, i1 = i + stride - 1, j0 = j - stride + 1, j1 = j + stride - 1;
    if (tz < tx && tz < ty) {
      t = std::max(t, tz);
      k += pz ? 1 : -1;
      if (t >= max_range) return no_hit;
      if (k < 0 || k >= top) return t;
      i = std::clamp(static_cast<int>(gx + t * sx), i0, i1);
      j = std::clamp(static_cast<int>(gy + t * sy), j0, j1);
      continue;
    }
    t = std::max(t, std::min(tx, ty));
    if (t >= max_range) return no_hit;
    if (tx < ty) {
      i = px ? i + stride : i - stride;
      j = std::clamp(static_cast<int>(gy + t * sy), j0, j1);
    } else {
      j = py ? j + stride : j - stride;
      i = std::clamp(static_cast<int>(gx + t * sx), i0, i1);
    }
    if (!inside(i, j)) return open_sides_ ? cast_beside(from, direction, max_range) : t;
  }
}

}  // namespace adit::sim
