// SPDX-License-Identifier: Apache-2.0
#include "sim/world/voxel_grid.hpp"

#include <algorithm>
#include <cmath>

#include "sim/world/voxel_lanes.hpp"

namespace adit::sim {
namespace {

constexpr int kMostCells = 255;  // What a byte counts.
constexpr int kMostLayers = 15;  // What half a byte counts.

/// `value` brought between two others. Not std::clamp, which GCC 12 compiles to branches.
int keep(int value, int low, int high) {
  value = value < low ? low : value;
  return value > high ? high : value;
}

/// 0: layers have different thickness. Asked for every column of a scan; it is exact enough to look at three
/// of the borders.
double layers_per_metre(const std::vector<double>& levels) {
  const std::size_t layers = levels.size() - 1;
  const double thickness = (levels.back() - levels.front()) / static_cast<double>(layers);
  const auto in_place = [&](std::size_t n) {
    return std::abs(levels[n] - levels.front() - static_cast<double>(n) * thickness) < 0.1 * thickness;
  };
  return in_place(1) && in_place(layers / 2) && in_place(layers - 1) ? 1.0 / thickness : 0.0;
}

}  // namespace

VoxelGrid::VoxelGrid(const Eigen::Vector2d& origin, double resolution, int nx, int ny,
                     std::vector<double> levels, bool open_sides)
    : origin_(origin),
      resolution_(resolution),
      per_metre_(1.0 / resolution),
      nx_(nx),
      ny_(ny),
      open_sides_(open_sides),
      levels_(std::move(levels)),
      strides_{} {
  // One more than cells: VoxelLanes reads a byte beyond.
  strides_[kTowardsBoth].resize(static_cast<std::size_t>(nx) * ny * (levels_.size() - 1) + 1);
}

void VoxelGrid::build() {
  for (int quadrant = 0; quadrant < kTowardsBoth; ++quadrant) {
    std::vector<Stride>& mirrored = strides_[quadrant];
    mirrored.resize(strides_[kTowardsBoth].size());
    for (int j = 0; j < ny_; ++j)
      for (int i = 0; i < nx_; ++i)
        for (int k = 0; k < layers(); ++k)
          mirrored[index(quadrant & 1 ? i : nx_ - 1 - i, quadrant & 2 ? j : ny_ - 1 - j, k)].width =
              solid(i, j, k) ? 0 : 1;
  }
  // Open cells in a line along x and along y, from each cell of the newest row on.
  struct Run {
    int width{}, depth{};
  };
  std::vector<Run> runs(static_cast<std::size_t>(nx_) * layers());
  for (std::vector<Stride>& strides : strides_)
    for (int j = ny_ - 1; j >= 0; --j)
      for (int i = nx_ - 1; i >= 0; --i) {
        Stride* const column = &strides[index(i, j, 0)];
        Run* const run = &runs[static_cast<std::size_t>(i) * layers()];
        // What lies beside the grid counts as solid: no stride leaves it by more than one cell.
        const bool at_side = i == nx_ - 1 || j == ny_ - 1;
        for (int k = 0; k < layers(); ++k) {
          if (column[k].width == 0) {
            run[k] = {};
            continue;
          }
          column[k].depth = 1;
          if (at_side) {
            run[k] = {1, 1};
            continue;
          }
          run[k] = {std::min(kMostCells, run[layers() + k].width + 1),
                    std::min(kMostCells, run[k].depth + 1)};
          choose_rectangle(column[k], run[k].width, run[k].depth, strides[index(i + 1, j, k)],
                           strides[index(i, j + 1, k)], strides[index(i + 1, j + 1, k)]);
        }
        for (int k = 0; k < layers(); ++k) {
          const auto reach = [&](int step) {
            int n = 0;
            for (int at = k + step; n < kMostLayers && at >= 0 && at < layers(); at += step, ++n)
              if (column[at].width < column[k].width || column[at].depth < column[k].depth) break;
            return n;
          };
          if (column[k].width != 0) column[k].layers = static_cast<std::uint8_t>(reach(-1) | reach(1) << 4);
        }
      }
}

void VoxelGrid::choose_rectangle(Stride& stride, int widest, int deepest, const Stride& right,
                                 const Stride& left, const Stride& both) {
  int most = 0;
  const auto propose = [&](int width, int depth) {
    width = std::min(width, widest);
    depth = std::min(depth, deepest);
    // What makes a rectangle longer than two squares is worth nothing to most rays.
    const int worth = std::min(width, 2 * depth) * std::min(depth, 2 * width);
    if (worth <= most) return;
    most = worth;
    stride.width = static_cast<std::uint8_t>(width);
    stride.depth = static_cast<std::uint8_t>(depth);
  };
  propose(widest, 1);
  propose(1, deepest);
  propose(right.width + 1, right.depth);
  propose(left.width, left.depth + 1);
  propose(both.width + 1, both.depth + 1);
}

VoxelGrid::Start VoxelGrid::locate(const Eigen::Vector3d& position) const {
  Start start{
      position, (position.x() - origin_.x()) / resolution_, (position.y() - origin_.y()) / resolution_, 0, 0,
      -1};
  // Far outside the range of int the value is only compared, so it may be clamped.
  start.i = static_cast<int>(std::floor(std::clamp(start.gx, -1e6, 1e6)));
  start.j = static_cast<int>(std::floor(std::clamp(start.gy, -1e6, 1e6)));
  if (position.z() >= levels_.front() && position.z() < levels_.back())
    start.k =
        static_cast<int>(std::upper_bound(levels_.begin(), levels_.end(), position.z()) - levels_.begin()) -
        1;
  return start;
}

double VoxelGrid::cast_beside(const Start& start, const Eigen::Vector3d& direction, double max_range) const {
  if (direction.z() == 0.0) return kNoHit;
  const double border = direction.z() > 0.0 ? levels_.back() : levels_.front();
  const double t = (border - start.position.z()) / direction.z();
  return t < max_range ? t : kNoHit;
}

bool VoxelGrid::enter(Start& start, const Eigen::Vector3d& direction, double& t) const {
  double first = 0.0, last = kNoHit;
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
  start.i =
      std::clamp(static_cast<int>(std::floor(start.gx + first * direction.x() / resolution_)), 0, nx_ - 1);
  start.j =
      std::clamp(static_cast<int>(std::floor(start.gy + first * direction.y() / resolution_)), 0, ny_ - 1);
  start.k = static_cast<int>(std::upper_bound(levels_.begin(), levels_.end(), z) - levels_.begin()) - 1;
  return true;
}

/// A ray under way, in a grid mirrored so that it heads towards +x and +y.
struct VoxelGrid::Ray {
  const Stride* strides;  ///< Strides of that mirrored grid.
  double gx, gy;          ///< Start, in columns.
  double sx, sy;          ///< Columns per metre, >= 0.
  double ax, ay, az;      ///< Metres per column, metres per metre of height.
  double t;               ///< m
  int i, j, k;
  int up, dk;  ///< Upwards: 1 and 1; downwards: 0 and -1.
};

bool VoxelGrid::prepare(const Start& from, const Eigen::Vector3d& direction, double max_range, Ray& ray,
                        double& range) const {
  range = 0.0;
  if (from.k < 0) return false;
  Start start = from;
  ray.t = 0.0;
  if (!inside(start.i, start.j)) {
    if (!open_sides_) return false;
    if (!enter(start, direction, ray.t)) {
      range = cast_beside(from, direction, max_range);
      return false;
    }
    range = kNoHit;
    if (ray.t >= max_range) return false;
  }
  // An axis that the ray does not move along gets a border far away instead of a division by zero.
  constexpr double far = VoxelLanes::kFar;
  const bool px = direction.x() >= 0.0, py = direction.y() >= 0.0, pz = direction.z() >= 0.0;
  ray.strides = strides_[(px ? 1 : 0) + (py ? 2 : 0)].data();
  ray.gx = px ? start.gx : nx_ - start.gx;
  ray.gy = py ? start.gy : ny_ - start.gy;
  const double dx = std::abs(direction.x()), dy = std::abs(direction.y());
  ray.sx = dx * per_metre_;
  ray.sy = dy * per_metre_;
  ray.ax = dx != 0.0 ? resolution_ / dx : far;
  ray.ay = dy != 0.0 ? resolution_ / dy : far;
  ray.az = direction.z() != 0.0 ? 1.0 / direction.z() : far;
  ray.i = px ? start.i : nx_ - 1 - start.i;
  ray.j = py ? start.j : ny_ - 1 - start.j;
  ray.k = start.k;
  ray.up = pz ? 1 : 0;
  ray.dk = pz ? 1 : -1;
  return true;
}

bool VoxelGrid::cast_together(const Start& from, std::span<const Eigen::Vector3d> directions,
                              double max_range, std::span<double> ranges) const {
  const bool px = directions[0].x() >= 0.0, py = directions[0].y() >= 0.0;
  VoxelLanes lanes;
  for (const Eigen::Vector3d& direction : directions) {
    if ((direction.x() >= 0.0) != px || (direction.y() >= 0.0) != py) return false;
    lanes.dx[lanes.count] = std::abs(direction.x());
    lanes.dy[lanes.count] = std::abs(direction.y());
    lanes.dz[lanes.count++] = direction.z();
  }
  for (int at = lanes.count; at % VoxelLanes::kWide != 0; ++at) {
    lanes.dx[at] = lanes.dx[0];
    lanes.dy[at] = lanes.dy[0];
    lanes.dz[at] = lanes.dz[0];
  }
  lanes.gx = px ? from.gx : nx_ - from.gx;
  lanes.gy = py ? from.gy : ny_ - from.gy;
  lanes.i = px ? from.i : nx_ - 1 - from.i;
  lanes.j = py ? from.j : ny_ - 1 - from.j;
  lanes.k = from.k;
  lanes.resolution = resolution_;
  lanes.columns_per_metre = per_metre_;
  static_assert(sizeof(Stride) == VoxelLanes::kBytes);
  lanes.strides = &strides_[(px ? 1 : 0) + (py ? 2 : 0)].data()->width;
  lanes.levels = levels_.data();
  lanes.nx = nx_;
  lanes.ny = ny_;
  lanes.layers = layers();
  lanes.layers_per_metre = layers_per_metre(levels_);
  lanes.z = from.position.z();
  lanes.max_range = max_range;
  std::array<LaneEnd, VoxelLanes::kMax> ends;
  cast_lanes(lanes, ends.data());
  for (std::size_t n = 0; n < directions.size(); ++n) {
    switch (ends[n]) {
      case LaneEnd::met:
        ranges[n] = lanes.t[n];
        break;
      case LaneEnd::far:
        ranges[n] = kNoHit;
        break;
      case LaneEnd::outside:
        ranges[n] = open_sides_ ? cast_beside(from, directions[n], max_range) : lanes.t[n];
        break;
    }
  }
  return true;
}

void VoxelGrid::cast(const Start& from, std::span<const Eigen::Vector3d> directions, double max_range,
                     std::span<double> ranges) const {
  constexpr std::size_t kFew = 3;  // Not worth it.
  const bool in_grid = from.k >= 0 && inside(from.i, from.j);
  if (directions.size() <= kFew || !in_grid || !has_voxel_lanes())
    return cast_each(from, directions, max_range, ranges);
  for (std::size_t first = 0; first < directions.size(); first += VoxelLanes::kMax) {
    const std::size_t count = std::min<std::size_t>(VoxelLanes::kMax, directions.size() - first);
    const auto some = directions.subspan(first, count);
    const auto into = ranges.subspan(first, count);
    if (!cast_together(from, some, max_range, into)) cast_each(from, some, max_range, into);
  }
}

void VoxelGrid::cast_each(const Start& from, std::span<const Eigen::Vector3d> directions, double max_range,
                          std::span<double> ranges) const {
  const double z = from.position.z();
  const int top = layers(), row = nx_ * top;
  const double* const levels = levels_.data();
  for (std::size_t n = 0; n < directions.size(); ++n) {
    Ray ray;
    double& range = ranges[n];
    if (!prepare(from, directions[n], max_range, ray, range)) continue;
    int i = ray.i, j = ray.j, k = ray.k;
    double t = ray.t;
    const auto border = [&](int layer) { return (levels[layer + ray.up] - z) * ray.az; };
    while (true) {
      const Stride stride = ray.strides[j * row + i * top + k];
      if (stride.width == 0) {
        range = t;
        break;
      }
      const int next_i = i + stride.width, next_j = j + stride.depth;
      const double tx = (next_i - ray.gx) * ray.ax, ty = (next_j - ray.gy) * ray.ay;
      const double side = std::min(tx, ty);
      const int last = k + ray.dk * (ray.up ? stride.layers >> 4 : stride.layers & kMostLayers);
      const double tz = border(last);
      // The axes that do not cross a border are clamped to the rectangle: rounding cannot lead astray.
      if (tz < side) {
        t = std::max(t, tz);
        if (t >= max_range) {
          range = kNoHit;
          break;
        }
        k = last + ray.dk;
        if (k < 0 || k >= top) {
          range = t;
          break;
        }
        i = keep(static_cast<int>(ray.gx + t * ray.sx), i, next_i - 1);
        j = keep(static_cast<int>(ray.gy + t * ray.sy), j, next_j - 1);
        continue;
      }
      while (k != last && border(k) < side) k += ray.dk;
      t = std::max(t, side);
      if (t >= max_range) {
        range = kNoHit;
        break;
      }
      const int in_i = keep(static_cast<int>(ray.gx + t * ray.sx), i, next_i - 1);
      const int in_j = keep(static_cast<int>(ray.gy + t * ray.sy), j, next_j - 1);
      i = tx < ty ? next_i : in_i;
      j = tx < ty ? in_j : next_j;
      if (i >= nx_ || j >= ny_) {
        range = open_sides_ ? cast_beside(from, directions[n], max_range) : t;
        break;
      }
    }
  }
}

double VoxelGrid::cast(const Start& start, const Eigen::Vector3d& direction, double max_range) const {
  double range = kNoHit;
  cast_each(start, std::span(&direction, 1), max_range, std::span(&range, 1));
  return range;
}

}  // namespace adit::sim
