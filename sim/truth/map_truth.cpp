// SPDX-License-Identifier: Apache-2.0
#include "sim/truth/map_truth.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/truth/lidar_turn.hpp"

namespace adit::sim {
namespace {

constexpr int kKeyBits = 21;
constexpr std::int64_t kKeyOrigin = std::int64_t{1} << (kKeyBits - 1);

/// Key of the cube of that edge that holds a place.
std::uint64_t key_of(const Eigen::Vector3d& place, double edge) {
  std::uint64_t key = 0;
  for (int a = 0; a < 3; ++a) {
    const auto cell = static_cast<std::int64_t>(std::floor(place[a] / edge)) + kKeyOrigin;
    key = key << kKeyBits | (static_cast<std::uint64_t>(cell) & ((std::uint64_t{1} << kKeyBits) - 1));
  }
  return key;
}

/// Occupied voxels by cubes of their own edge, sorted: cubes of other maps need not be aligned with ours.
class VoxelIndex {
 public:
  explicit VoxelIndex(const MapVoxels& map) : edge_(map.edge) {
    entries_.reserve(map.occupied.size());
    for (const Eigen::Vector3f& centre : map.occupied)
      entries_.push_back({key_of(centre.cast<double>(), edge_), centre});
    std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) { return a.key < b.key; });
  }

  /// Whether an occupied voxel's box is within `reach` of a point.
  bool near(const Eigen::Vector3d& point, double reach) const {
    const int cells = static_cast<int>(std::ceil((reach + 0.5 * edge_) / edge_));
    for (int x = -cells; x <= cells; ++x)
      for (int y = -cells; y <= cells; ++y)
        for (int z = -cells; z <= cells; ++z)
          if (near_in(key_of(point + edge_ * Eigen::Vector3d(x, y, z), edge_), point, reach)) return true;
    return false;
  }

 private:
  struct Entry {
    std::uint64_t key{};
    Eigen::Vector3f centre{};
  };
  bool near_in(std::uint64_t key, const Eigen::Vector3d& point, double reach) const {
    auto at = std::lower_bound(entries_.begin(), entries_.end(), key,
                               [](const Entry& e, std::uint64_t k) { return e.key < k; });
    for (; at != entries_.end() && at->key == key; ++at) {
      const Eigen::Vector3d beside =
          ((point - at->centre.cast<double>()).cwiseAbs().array() - 0.5 * edge_).max(0.0);
      if (beside.norm() <= reach) return true;
    }
    return false;
  }

  double edge_;
  std::vector<Entry> entries_{};
};

int layer_of(const VoxelGrid& grid, double z) {
  const std::vector<double>& levels = grid.levels();
  return static_cast<int>(std::upper_bound(levels.begin(), levels.end(), z) - levels.begin()) - 1;
}

/// Below and above the grid all is solid; beside it what the grid says.
bool is_solid(const VoxelGrid& grid, int i, int j, int k) {
  if (k < 0 || k >= grid.layers()) return true;
  if (!grid.inside(i, j)) return !grid.open_sides();
  return grid.solid(i, j, k);
}

/// Whether both solid and open cells are within `reach` of a box, that is, a surface.
bool surface_near(const VoxelGrid& grid, const Eigen::Vector3d& centre, double half, double reach) {
  const Eigen::Vector3d low = centre.array() - half - reach, high = centre.array() + half + reach;
  const int k0 = layer_of(grid, low.z()), k1 = layer_of(grid, high.z());
  bool solid = false, open = false;
  for (int k = k0; k <= k1; ++k) {
    // Below the first and above the last level the solid has no end.
    const double bottom =
        k < 0 ? -std::numeric_limits<double>::infinity() : grid.levels()[static_cast<std::size_t>(k)];
    const double top = k < 0                ? grid.levels().front()
                       : k >= grid.layers() ? std::numeric_limits<double>::infinity()
                                            : grid.levels()[static_cast<std::size_t>(k) + 1];
    const double dz = std::max({0.0, bottom - centre.z() - half, centre.z() - half - top});
    for (int j = grid.column_y(low.y()); j <= grid.column_y(high.y()); ++j)
      for (int i = grid.column_x(low.x()); i <= grid.column_x(high.x()); ++i) {
        const Eigen::Vector2d beside =
            ((grid.centre(i, j) - centre.head<2>()).cwiseAbs().array() - half - 0.5 * grid.resolution())
                .max(0.0);
        if (std::hypot(beside.x(), beside.y(), dz) > reach) continue;
        (is_solid(grid, i, j, k) ? solid : open) = true;
        if (solid && open) return true;
      }
  }
  return false;
}

double share_of(std::size_t part, std::size_t all) {
  return all == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(all);
}

}  // namespace

MapJudgement judge_map(const MapVoxels& map, std::span<const Eigen::Vector3f> surface, const World& world,
                       const MapLimits& limits) {
  const VoxelGrid& grid = world.grid();
  const VoxelIndex index(map);
  std::size_t held = 0, stray = 0, solid = 0;
  for (const Eigen::Vector3f& point : surface) held += index.near(point.cast<double>(), limits.held);
  for (const Eigen::Vector3f& centre : map.occupied)
    stray += !surface_near(grid, centre.cast<double>(), 0.5 * map.edge, limits.far);
  for (const Eigen::Vector3f& centre : map.free)
    solid += is_solid(grid, grid.column_x(centre.x()), grid.column_y(centre.y()),
                      layer_of(grid, static_cast<double>(centre.z())));
  MapJudgement out;
  out.share = share_of(held, surface.size());
  out.wrong_occupied = share_of(stray, map.occupied.size());
  out.wrong_free = share_of(solid, map.free.size());
  out.area = static_cast<double>(surface.size()) * SeenSurface::kPatch * SeenSurface::kPatch;
  return out;
}

SeenSurface::SeenSurface(std::shared_ptr<const World> world, std::span<const Platform> robots)
    : world_(std::move(world)), robots_(robots.begin(), robots.end()) {
  for (const Platform& platform : robots_) {
    const LidarConfig config = platform.lidar();
    LidarParams lidar;
    lidar.rings = config.rings;
    lidar.lowest = config.lowest;
    lidar.highest = config.highest;
    lidar.columns = 450;
    lidars_.emplace_back(lidar);
  }
}

void SeenSurface::look(std::size_t robot, const Pose3& base) {
  const Pose3 sensor = base * robots_[robot].lidar().mounting.pose();
  for_each_beam(*world_, lidars_[robot], sensor, kRange,
                [&](const Eigen::Vector3d& direction, double length) {
                  if (!(length < kRange)) return;
                  const Eigen::Vector3d hit = sensor.position + length * direction;
                  if (known_.insert(key_of(hit, kPatch)).second) points_.push_back(hit.cast<float>());
                });
}

void SeenSurfaceRecord::look(std::size_t robot, const Pose3& base) {
  constexpr double kMoved = 0.05, kTurned = 0.01;  // m and rad: from less it sees the same
  const auto [last, first] = looked_.try_emplace(robot, base);
  const bool still = !first && (last->second.position - base.position).norm() < kMoved &&
                     last->second.orientation.angularDistance(base.orientation) < kTurned;
  if (still) return;
  last->second = base;
  surface_.look(robot, base);
}

}  // namespace adit::sim
