// SPDX-License-Identifier: Apache-2.0
#include "perception/map/scan_masks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/geometry/round_down.hpp"
#include "perception/map/block_hash.hpp"

namespace adit::perception {
namespace {

/// The table covers this much more than the rays, voxels: rounding may lead a walk one voxel astray.
constexpr int kMargin = 2;
/// Rays that meet the ground at less than this rise per metre of their length graze it.
constexpr float kGrazingRise = 0.35f;
/// Voxels from the end of a grazing ray that it does not free: 1.5 edges from the surface.
constexpr int kGrazingSteps = 1;

Eigen::Vector3i floor_of(const Eigen::Vector3f& at) {
  return {round_down(at.x()), round_down(at.y()), round_down(at.z())};
}

}  // namespace

bool ScanMasks::collect(const Rays& rays, double resolution) {
  const double per_metre = 1.0 / resolution;
  ends_.clear();
  if (!rays.origin.allFinite() || !(rays.max_range > 0.0f)) return false;
  const Eigen::Vector3d origin = rays.origin.cast<double>() * per_metre;
  if (origin.cwiseAbs().maxCoeff() > 8.0 * BlockIndex::kLimit - 2 * kMaxRange) return false;
  const float range = std::min(rays.max_range * static_cast<float>(per_metre), kMaxRange);
  // Relative to the origin's block, where single precision resolves a thousandth of a voxel.
  const Eigen::Vector3i centre = (origin / 8.0).array().floor().cast<int>();
  const Eigen::Vector3d corner = 8.0 * centre.cast<double>();
  const Eigen::Vector3f start = (origin - corner).cast<float>();
  Eigen::Vector3f low = start, high = start;
  for (std::size_t i = 0; i < rays.points.size(); ++i) {
    const Eigen::Vector3f& point = rays.points[i];
    if (!point.allFinite()) continue;
    Eigen::Vector3f at = (point.cast<double>() * per_metre - corner).cast<float>();
    const float squared = (at - start).squaredNorm();
    const bool in_range = squared <= range * range;
    if (!in_range) at = start + (at - start) * (range / std::sqrt(squared));
    if (!at.allFinite()) continue;
    low = low.cwiseMin(at);
    high = high.cwiseMax(at);
    ends_.push_back({at, in_range && (i >= rays.moving.size() || rays.moving[i] == 0)});
  }
  if (ends_.empty()) return false;
  const Eigen::Vector3i first = (floor_of(low).array() - kMargin).unaryExpr([](int v) { return v >> 3; });
  const Eigen::Vector3i last = (floor_of(high).array() + kMargin).unaryExpr([](int v) { return v >> 3; });
  base_ = centre + first;
  size_ = last - first + Eigen::Vector3i::Ones();
  const Eigen::Vector3f shift = -8.0f * first.cast<float>();
  for (End& end : ends_) end.at += shift;
  origin_ = start + shift;
  return true;
}

ScanBlock& ScanMasks::block(std::size_t cell) {
  if (table_[cell] != 0) return blocks_[table_[cell] - 1];
  if (used_ == blocks_.size()) blocks_.resize(std::max<std::size_t>(256, 2 * used_));
  ScanBlock& made = blocks_[used_++];
  const int at = static_cast<int>(cell);
  made = {{base_.x() + at % size_.x(), base_.y() + at / size_.x() % size_.y(),
           base_.z() + at / (size_.x() * size_.y())},
          {},
          {}};
  table_[cell] = static_cast<std::uint32_t>(used_);
  touched_.push_back(cell);
  return made;
}

bool ScanMasks::is_grazing(const End& end, const OccupiedBefore& occupied_before) const {
  const Eigen::Vector3f up = origin_ - end.at;
  if (!end.hit || up.z() <= 0.0f || up.z() > kGrazingRise * up.norm()) return false;
  // The end is ground when nothing stands on it.
  const Eigen::Vector3i v = floor_of(end.at) + 8 * base_;
  return !occupied_before(v.x(), v.y(), v.z() + 1);
}

void ScanMasks::walk(const End& end, bool grazing) {
  const Eigen::Vector3i from = floor_of(end.at), to = floor_of(origin_);
  const Eigen::Vector3f way = origin_ - end.at;
  std::array<int, 3> local{}, last{}, bits{1, 8, 64}, edge{};
  std::array<std::ptrdiff_t, 3> cells{1, size_.x(), static_cast<std::ptrdiff_t>(size_.x()) * size_.y()};
  std::array<float, 3> next{}, delta{};
  int steps = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const int difference = to[axis] - from[axis];
    steps += std::abs(difference);
    local[axis] = from[axis] & 7;
    last[axis] = to[axis];
    if (difference == 0) {
      next[axis] = delta[axis] = std::numeric_limits<float>::infinity();
      continue;
    }
    const bool up = difference > 0;
    delta[axis] = 1.0f / std::abs(way[axis]);
    const float inside = end.at[axis] - static_cast<float>(from[axis]);
    next[axis] = (up ? 1.0f - inside : inside) * delta[axis];
    edge[axis] = up ? 0 : 7;
    if (!up) {
      bits[axis] = -bits[axis];
      cells[axis] = -cells[axis];
    }
  }
  float nx = next[0], ny = next[1], nz = next[2];
  int bit = local[0] + 8 * local[1] + 64 * local[2];
  std::ptrdiff_t cell = static_cast<std::ptrdiff_t>(cell_of(from));
  std::uint64_t* free = block(static_cast<std::size_t>(cell)).free.data();
  int shared = 0;
  int unfreed = grazing ? kGrazingSteps : 0;
  const int layer = local[2];
  const auto advance = [&](int axis) {
    bit += bits[axis];
    local[axis] += bits[axis] > 0 ? 1 : -1;
    if ((local[axis] & 7) != edge[axis]) return;
    local[axis] &= 7;
    bit -= 8 * bits[axis];
    cell += cells[axis];
    free = block(static_cast<std::size_t>(cell)).free.data();
  };
  while (steps-- > 0) {
    if (nx < ny && nx < nz) {
      nx += delta[0];
      advance(0);
    } else if (ny < nz) {
      ny += delta[1];
      advance(1);
    } else {
      nz += delta[2];
      advance(2);
    }
    if (unfreed > 0) {
      --unfreed;
      if (local[2] == layer) continue;
    }
    std::uint64_t& word = free[bit >> 6];
    const std::uint64_t mask = std::uint64_t{1} << (bit & 63);
    if ((word & mask) != 0) {
      if (++shared >= kSharedVoxels && steps < kNearSteps) return;
    } else {
      word |= mask;
      shared = 0;
    }
  }
}

void ScanMasks::trace(const Rays& rays, double resolution, const OccupiedBefore& occupied_before) {
  for (const std::size_t cell : touched_) table_[cell] = 0;
  touched_.clear();
  used_ = 0;
  if (!collect(rays, resolution)) return;
  const std::size_t cells = static_cast<std::size_t>(size_.x()) * size_.y() * size_.z();
  if (table_.size() < cells) table_.resize(cells, 0);
  // The ends of rays first: one ray for all points in a voxel. As with OctoMap, a ray that ends at the range
  // alone does not free the voxel in which it ends.
  std::size_t remaining = 0;
  for (std::size_t i = 0; i < ends_.size(); ++i) {
    const End end = ends_[i];
    const Eigen::Vector3i voxel = floor_of(end.at);
    ScanBlock& in = block(cell_of(voxel));
    const int layer = voxel.z() & 7;
    const std::uint64_t mask = std::uint64_t{1} << ((voxel.x() & 7) + 8 * (voxel.y() & 7));
    if (end.hit && (in.hit[layer] & mask) != 0) continue;
    if (end.hit) in.hit[layer] |= mask;
    ends_[remaining++] = end;
  }
  for (std::size_t i = 0; i < remaining; ++i) walk(ends_[i], is_grazing(ends_[i], occupied_before));
}

}  // namespace adit::perception
