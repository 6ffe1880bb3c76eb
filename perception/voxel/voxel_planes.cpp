// SPDX-License-Identifier: Apache-2.0
#include "perception/voxel/voxel_planes.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

namespace adit::perception {
namespace {

constexpr std::uint16_t kFirstFit = 6;     ///< Points of the first plane.
constexpr std::uint16_t kMaxPoints = 60;   ///< Further points do not change a voxel.
constexpr float kPlanar = 9.0f;            ///< A plane's second extent is at least 3 times its thickness.
constexpr float kLineWidth = 0.12f;        ///< Standard deviation across the thickest line, m.
constexpr double kSlack = 0.1;             ///< How far beside an empty voxel a plane is still found, m.
constexpr float kFacingBorder = 0.7f;      ///< Of a plane's normal, towards the border of its voxel.
constexpr float kUpright = 0.9f;           ///< Vertical part of a line's direction.
constexpr std::size_t kPointsInVoxel = 8;  ///< At least so many of a dense cloud share the smallest voxel.
constexpr float kMaxIndex = 1e6f;          ///< Of a voxel along an axis.
constexpr double kReach = 80.0;            ///< A voxel takes points within so many of its edges.
constexpr int kCandidates = 8;             ///< Voxels of which the costliest makes room for a new one.
constexpr std::size_t kSweepPart = 64;     ///< Calls of forget() that visit the whole table.

}  // namespace

void VoxelPlanes::add(Cell& cell, const Eigen::Vector3f& point) {
  const auto n = static_cast<float>(++cell.count);
  const Eigen::Vector3f d = point - cell.mean;
  cell.mean += d / n;
  const Eigen::Vector3f e = point - cell.mean;
  cell.m2[0] += d.x() * e.x();
  cell.m2[1] += d.x() * e.y();
  cell.m2[2] += d.x() * e.z();
  cell.m2[3] += d.y() * e.y();
  cell.m2[4] += d.y() * e.z();
  cell.m2[5] += d.z() * e.z();
}

std::size_t VoxelPlanes::insert(std::span<const Eigen::Vector3d> points, const Eigen::Vector3d& lidar,
                                double travelled) {
  const auto now = static_cast<float>(travelled);
  std::size_t refused = 0;
  ++cloud_;
  for (int level = 0; level < params_.levels; ++level) {
    FlatHash<Cell>& cells = levels_[static_cast<std::size_t>(level)];
    const float size = edge(level);
    const double scale = 1.0 / size;
    const double reach = level + 1 < params_.levels ? kReach * size : std::numeric_limits<double>::infinity();
    std::size_t without_room = 0;
    for (const Eigen::Vector3d& p : points) {
      const double squared = (p - lidar).squaredNorm();
      if (squared > reach * reach) continue;
      const Eigen::Vector3d index = (p * scale).array().floor();
      if (!(index.cwiseAbs().maxCoeff() < kMaxIndex)) continue;  // Also of NaN.
      const Eigen::Vector3i at = index.cast<int>();
      const std::uint64_t key = voxel_key(at.x(), at.y(), at.z());
      Cell* cell = cells.size() < params_.max_voxels ? &cells.at(key) : cells.find(key);
      if (!cell) cell = make(level, key, lidar, static_cast<float>(std::sqrt(squared)), now);
      if (!cell) {
        ++without_room;
        continue;
      }
      if (cell->clouds < 255 && (cell->clouds == 0 || cell->cloud != cloud_)) ++cell->clouds;
      cell->cloud = cloud_;
      cell->touched = now;
      if (cell->count >= kMaxPoints) continue;
      add(*cell, (p - at.cast<double>() * static_cast<double>(size)).cast<float>());
      if (cell->count >= kFirstFit && cell->count >= std::uint32_t{cell->fitted} + cell->fitted / 2)
        fit(*cell, size);
    }
    refused = std::max(refused, without_room);
  }
  return refused;
}

VoxelPlanes::Cell* VoxelPlanes::make(int level, std::uint64_t key, const Eigen::Vector3d& lidar, float range,
                                     float travelled) {
  const auto n = static_cast<std::size_t>(level);
  const float size = edge(level);
  const Eigen::Vector3f from = (lidar / static_cast<double>(size)).cast<float>();
  // The way until the body sees it again, if it turned round, and the way since it was seen.
  const auto cost = [&](const FlatHash<Cell>::Slot& slot) {
    return size * (voxel_of(slot.key).cast<float>() - from).norm() + travelled - slot.value.touched;
  };
  if (!levels_[n].evict(hand_[n], kCandidates, range, cost)) return nullptr;
  return &levels_[n].at(key);
}

VoxelPlanes VoxelPlanes::of(std::span<const Eigen::Vector3f> points, const Params& params) {
  VoxelPlanes out(params);
  const float finest = params.finest, scale = 1.0f / finest;
  FlatHash<Cell>& smallest = out.levels_[0] = FlatHash<Cell>(points.size() / kPointsInVoxel);
  std::uint64_t last_key = FlatHash<Cell>::kEmpty;
  Cell* last = nullptr;  // Points that were measured one after another often share their voxel.
  for (const Eigen::Vector3f& p : points) {
    const Eigen::Vector3f index = (p * scale).array().floor();
    if (!(index.cwiseAbs().maxCoeff() < kMaxIndex)) continue;  // Also of NaN.
    const auto key = voxel_key(static_cast<std::int32_t>(index.x()), static_cast<std::int32_t>(index.y()),
                               static_cast<std::int32_t>(index.z()));
    if (key != last_key) {
      last = smallest.size() < params.max_voxels ? &smallest.at(key) : smallest.find(key);
      last_key = key;
    }
    if (last) add(*last, p - finest * index);
  }
  for (int level = 0; level < params.levels; ++level) {
    const auto n = static_cast<std::size_t>(level);
    const float size = out.edge(level);
    for (auto& slot : out.levels_[n].values()) {
      Cell& cell = slot.value;
      if (slot.key == FlatHash<Cell>::kEmpty) continue;
      cell.clouds = 1;
      if (level + 1 < params.levels) {
        const Eigen::Vector3i at = voxel_of(slot.key),
                              above = at.array().unaryExpr([](int v) { return v >> 1; });
        // The table above grows at most to the size of this one.
        join(out.levels_[n + 1].at(voxel_key(above.x(), above.y(), above.z())), cell,
             size * (at - 2 * above).cast<float>());
      }
      if (cell.count >= kFirstFit) out.fit(cell, size);
    }
  }
  return out;
}

void VoxelPlanes::join(Cell& cell, const Cell& part, const Eigen::Vector3f& shift) {
  // Chan et al. 1979: moments of two sets about their common mean.
  const auto a = static_cast<float>(cell.count), b = static_cast<float>(part.count);
  const Eigen::Vector3f d = part.mean + shift - cell.mean;
  cell.count += part.count;
  cell.mean += (b / (a + b)) * d;
  const float w = a * b / (a + b);
  cell.m2[0] += part.m2[0] + w * d.x() * d.x();
  cell.m2[1] += part.m2[1] + w * d.x() * d.y();
  cell.m2[2] += part.m2[2] + w * d.x() * d.z();
  cell.m2[3] += part.m2[3] + w * d.y() * d.y();
  cell.m2[4] += part.m2[4] + w * d.y() * d.z();
  cell.m2[5] += part.m2[5] + w * d.z() * d.z();
}

void VoxelPlanes::fit(Cell& cell, float voxel_edge) const {
  const auto n = static_cast<float>(cell.count);
  Eigen::Matrix3f covariance;
  covariance << cell.m2[0], cell.m2[1], cell.m2[2], cell.m2[1], cell.m2[3], cell.m2[4], cell.m2[2],
      cell.m2[4], cell.m2[5];
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver;
  solver.computeDirect(covariance / (n - 1));
  const Eigen::Vector3f spread = solver.eigenvalues().cwiseMax(0.0f);
  cell.fitted = static_cast<std::uint16_t>(std::min<std::uint32_t>(cell.count, 65535));
  cell.normal = solver.eigenvectors().col(0);
  cell.along = solver.eigenvectors().col(1);
  // Few points have little spread by chance.
  const float known = params_.noise * params_.noise / n;
  cell.variance = spread[0] + known;
  cell.extent_along = spread[1];
  // Thin for the sensor and for the voxel: two walls in one voxel are no plane.
  const float thin = std::max(2.0f * params_.noise, 0.06f * voxel_edge);
  const float wide = params_.wide * voxel_edge;
  cell.plane = spread[0] < thin * thin && spread[1] > wide * wide &&
               spread[1] > kPlanar * std::max(spread[0], 0.25f * params_.noise * params_.noise);
  // One ring of a lidar on a wall or on the ground also gives a line, but never an upright one.
  cell.line = !cell.plane && spread[1] < kLineWidth * kLineWidth && spread[2] > kPlanar * spread[1] &&
              std::abs(solver.eigenvectors()(2, 2)) > kUpright;
}

std::optional<PlanePatch> VoxelPlanes::find(const Eigen::Vector3d& place, int top) const {
  if (auto here = find_in(place, top)) return here;
  // A wall on the border of two voxels may have its points on the other side.
  const double size = edge(top);
  const Eigen::Vector3d index = (place / size).array().floor();
  const Eigen::Vector3d inside = place - index * size;
  for (int axis = 0; axis < 3; ++axis) {
    const double depth = std::min(inside[axis], size - inside[axis]);
    if (depth > kSlack) continue;
    Eigen::Vector3d beside = place;
    beside[axis] += inside[axis] < 0.5 * size ? -2 * depth - 1e-6 : 2 * depth + 1e-6;
    // Only what faces the border: a floor beyond it is another one's.
    const auto found = find_in(beside, top);
    if (found && std::abs(found->normal[axis]) > kFacingBorder) return found;
  }
  return std::nullopt;
}

std::optional<PlanePatch> VoxelPlanes::find_in(const Eigen::Vector3d& place, int top) const {
  for (int level = top; level >= 0; --level) {
    const double size = edge(level);
    const Eigen::Vector3d index = (place / size).array().floor();
    if (!(index.cwiseAbs().maxCoeff() < kMaxIndex)) return std::nullopt;  // Also of NaN.
    const Eigen::Vector3i at = index.cast<int>();
    const Cell* cell = levels_[static_cast<std::size_t>(level)].find(voxel_key(at.x(), at.y(), at.z()));
    if (!cell) return std::nullopt;  // A smaller voxel there would lie in this one.
    const bool line = cell->line && cell->clouds >= params_.line_clouds;
    if (!cell->plane && !line) continue;
    return PlanePatch{at.cast<double>() * size + cell->mean.cast<double>(),
                      cell->normal,
                      cell->along,
                      cell->variance,
                      cell->extent_along,
                      static_cast<float>(cell->count),
                      line};
  }
  return std::nullopt;
}

void VoxelPlanes::forget(double travelled) {
  const auto limit = static_cast<float>(travelled - params_.keep_distance);
  for (std::size_t level = 0; level < levels_.size(); ++level)
    sweep_[level] = levels_[level].sweep(sweep_[level], levels_[level].slots().size() / kSweepPart,
                                         [&](const Cell& cell) { return cell.touched < limit; });
}

void VoxelPlanes::clear() {
  for (FlatHash<Cell>& cells : levels_) cells.clear();
}

std::size_t VoxelPlanes::size() const {
  std::size_t all = 0;
  for (const FlatHash<Cell>& cells : levels_) all += cells.size();
  return all;
}

std::size_t VoxelPlanes::bytes() const {
  std::size_t all = 0;
  for (const FlatHash<Cell>& cells : levels_) all += cells.bytes();
  return all;
}

}  // namespace adit::perception
