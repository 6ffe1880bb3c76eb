// SPDX-License-Identifier: Apache-2.0
#include "perception/voxel/voxel_planes.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace adit::perception {
namespace {

constexpr std::uint16_t kFirstFit = 6;    ///< Points of the first plane.
constexpr std::uint16_t kMaxPoints = 60;  ///< Further points do not change a voxel.
constexpr float kPlanar = 9.0f;           ///< A plane's second extent is at least 3 times its thickness.
constexpr float kLineWidth = 0.12f;       ///< Standard deviation across the thickest line, m.
constexpr double kSlack = 0.1;            ///< How far beside an empty voxel a plane is still found, m.
constexpr float kUpright = 0.9f;          ///< Vertical part of a line's direction.
constexpr std::size_t kSweepPart = 64;    ///< Calls of forget() that visit the whole table.

}  // namespace

void VoxelPlanes::insert(std::span<const Eigen::Vector3d> points, double travelled) {
  for (int level = 0; level < kLevels; ++level) {
    FlatHash<Cell>& cells = levels_[static_cast<std::size_t>(level)];
    const float size = edge(level);
    const double scale = 1.0 / size;
    for (const Eigen::Vector3d& p : points) {
      const Eigen::Vector3i at = (p * scale).array().floor().cast<int>();
      const std::uint64_t key = voxel_key(at.x(), at.y(), at.z());
      Cell* cell = cells.size() < params_.max_voxels ? &cells.at(key) : cells.find(key);
      if (!cell) continue;
      if (cell->clouds < 255 && (cell->clouds == 0 || cell->touched != static_cast<float>(travelled)))
        ++cell->clouds;
      cell->touched = static_cast<float>(travelled);
      if (cell->count >= kMaxPoints) continue;
      const Eigen::Vector3f q = (p - at.cast<double>() * static_cast<double>(size)).cast<float>();
      const auto n = static_cast<float>(++cell->count);
      const Eigen::Vector3f d = q - cell->mean;
      cell->mean += d / n;
      const Eigen::Vector3f e = q - cell->mean;
      cell->m2[0] += d.x() * e.x();
      cell->m2[1] += d.x() * e.y();
      cell->m2[2] += d.x() * e.z();
      cell->m2[3] += d.y() * e.y();
      cell->m2[4] += d.y() * e.z();
      cell->m2[5] += d.z() * e.z();
      if (cell->count >= kFirstFit && cell->count >= cell->fitted + cell->fitted / 2) fit(*cell, size);
    }
  }
}

void VoxelPlanes::fit(Cell& cell, float voxel_edge) const {
  const float n = cell.count;
  Eigen::Matrix3f covariance;
  covariance << cell.m2[0], cell.m2[1], cell.m2[2], cell.m2[1], cell.m2[3], cell.m2[4], cell.m2[2],
      cell.m2[4], cell.m2[5];
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver;
  solver.computeDirect(covariance / (n - 1));
  const Eigen::Vector3f spread = solver.eigenvalues().cwiseMax(0.0f);
  cell.fitted = cell.count;
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

std::optional<PlanePatch> VoxelPlanes::find(const Eigen::Vector3d& place) const {
  const double size = edge(kLevels - 1);
  const Eigen::Vector3d index = (place / size).array().floor();
  const Eigen::Vector3i at = index.cast<int>();
  if (levels_.back().find(voxel_key(at.x(), at.y(), at.z()))) return find_in(place);
  // No point was ever here: the other side of a wall on the border of two voxels.
  const Eigen::Vector3d inside = place - index * size;
  Eigen::Index axis = 0;
  const double depth = inside.cwiseMin(Eigen::Vector3d::Constant(size) - inside).minCoeff(&axis);
  if (depth > kSlack) return std::nullopt;
  Eigen::Vector3d beside = place;
  beside[axis] += inside[axis] < 0.5 * size ? -2 * depth - 1e-6 : 2 * depth + 1e-6;
  return find_in(beside);
}

std::optional<PlanePatch> VoxelPlanes::find_in(const Eigen::Vector3d& place) const {
  for (int level = kLevels - 1; level >= 0; --level) {
    const double size = edge(level);
    const Eigen::Vector3i at = (place / size).array().floor().cast<int>();
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
  for (std::size_t level = 0; level < kLevels; ++level)
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
