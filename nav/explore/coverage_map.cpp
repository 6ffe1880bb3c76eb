// SPDX-License-Identifier: Apache-2.0
#include "nav/explore/coverage_map.hpp"

#include <limits>

namespace adit::nav {
namespace {

constexpr int kTileShift = 2;  // A tile has 4 x 4 columns.

std::size_t column_index(int x, int y) {
  return static_cast<std::size_t>((y & (CoverageMap::kSide - 1)) * CoverageMap::kSide +
                                  (x & (CoverageMap::kSide - 1)));
}

/// Visits the voxels along a line from its begin to its end, both included (Amanatides and Woo: *A fast voxel
/// traversal algorithm for ray tracing*, 1987).
/// `visit(voxel, last)`: returns false to end; `last`: the voxel holds the end of the line.
template <class Visit>
void walk_voxels(const Eigen::Vector3d& from, const Eigen::Vector3d& to, Visit&& visit) {
  const CoverageVoxel first = CoverageMap::voxel_at(from), end = CoverageMap::voxel_at(to);
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

}  // namespace

std::uint64_t CoverageMap::key(int tx, int ty, int band) {
  return (std::uint64_t{static_cast<std::uint32_t>(tx) & 0xff'ffffu} << 40) |
         (std::uint64_t{static_cast<std::uint32_t>(ty) & 0xff'ffffu} << 16) |
         (static_cast<std::uint32_t>(band) & 0xffffu);
}

int CoverageMap::find(int tx, int ty, int band) const {
  const auto found = index_.find(key(tx, ty, band));
  return found == index_.end() ? -1 : found->second;
}

CoverageMap::Column CoverageMap::column(int x, int y, int band) const {
  const int index = find(x >> kTileShift, y >> kTileShift, band);
  return index < 0 ? Column{} : tiles_[index].columns[column_index(x, y)];
}

CoverageMap::Column* CoverageMap::column_to_write(const CoverageVoxel& v) {
  const int tx = v.x >> kTileShift, ty = v.y >> kTileShift, band = band_of(v.z);
  if (last_ >= 0) {
    Tile& tile = tiles_[last_];
    if (tile.tx == tx && tile.ty == ty && tile.band == band) return &tile.columns[column_index(v.x, v.y)];
  }
  int index = find(tx, ty, band);
  if (index < 0) {
    if (tiles_.size() >= kMaxTiles) return nullptr;
    index = static_cast<int>(tiles_.size());
    tiles_.push_back({tx, ty, band, {}});
    index_.emplace(key(tx, ty, band), index);
  }
  last_ = index;
  return &tiles_[index].columns[column_index(v.x, v.y)];
}

void CoverageMap::add_ray(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const Eigen::Vector3d way = to - from;
  const double length = way.norm();
  if (!(length > 0.0)) return;
  const bool ends = length <= kRange;
  const Eigen::Vector3d end = ends ? to : Eigen::Vector3d(from + way * (kRange / length));
  walk_voxels(from, end, [&](const CoverageVoxel& v, bool last) {
    const bool hits = last && ends;
    // Most voxels that a ray passes were passed by another ray of the same scan.
    if (std::uint64_t* const noted = window_.find(v, hits)) {
      const std::uint64_t bit = window_.bit(v);
      if ((*noted & bit) != 0) return true;
      *noted |= bit;
    }
    Column* column = column_to_write(v);
    if (column == nullptr) {
      window_.clear();  // What has no place is tried again.
      return false;
    }
    const auto mask = static_cast<std::uint16_t>(1u << (v.z & 15));
    std::uint16_t& kind = hits ? column->hit : column->free;
    kind = static_cast<std::uint16_t>(kind | mask);
    return true;
  });
}

void CoverageMap::add_scan(std::span<const Eigen::Vector3f> points, const Eigen::Vector3d& sensor,
                           const Pose3& body) {
  const Eigen::Matrix3d turn = body.orientation.toRotationMatrix();
  const Eigen::Vector3d from = body.position + turn * sensor;
  window_.begin(voxel_at(from));
  for (const Eigen::Vector3f& p : points)
    if (p.allFinite()) add_ray(from, body.position + turn * p.cast<double>());
  forget_what_left();
}

void CoverageMap::forget_what_left() {
  window_.visit_passed([this](int x, int y, int z, std::uint64_t passed, std::uint64_t hits) {
    for (int band = band_of(z); band <= band_of(z + 63); ++band) {
      const int from = band * kSlices - z;
      const auto slice = [from](std::uint64_t bits) {
        return static_cast<std::uint16_t>(from < 0 ? bits << -from : bits >> from);
      };
      if (slice(passed) != 0) count(x, y, band, slice(passed), slice(hits));
    }
  });
}

// Rays also pass the free part of a voxel that holds the surface of something solid. Behind that surface
// nothing is seen, and the voxel stays as it is.
void CoverageMap::count(int x, int y, int band, std::uint16_t passed, std::uint16_t hits) {
  const int index = find(x >> kTileShift, y >> kTileShift, band);
  if (index < 0) return;
  Column& column = tiles_[index].columns[column_index(x, y)];
  const auto gone = static_cast<std::uint16_t>(passed & column.hit & ~hits);
  const auto most = [&column] { return column.passed[0] & column.passed[1] & column.passed[2]; };
  auto carry = static_cast<std::uint16_t>(gone & ~most());
  for (std::uint16_t& digit : column.passed) {
    digit = static_cast<std::uint16_t>(digit & ~hits);
    const auto both = static_cast<std::uint16_t>(digit & carry);
    digit = static_cast<std::uint16_t>(digit ^ carry);
    carry = both;
  }
  for (unsigned left = gone & most(); left != 0; left &= left - 1) {
    const int k = std::countr_zero(left), z = band * kSlices + k;
    const bool surrounded = seen({x - 1, y, z}) && seen({x + 1, y, z}) && seen({x, y - 1, z}) &&
                            seen({x, y + 1, z}) && seen({x, y, z - 1}) && seen({x, y, z + 1});
    if (!surrounded) continue;
    const auto others = static_cast<std::uint16_t>(~(1u << k));
    column.hit = static_cast<std::uint16_t>(column.hit & others);
    for (std::uint16_t& digit : column.passed) digit = static_cast<std::uint16_t>(digit & others);
  }
}

void CoverageMap::set_tried(const CoverageVoxel& voxel) {
  if (Column* column = column_to_write(voxel))
    column->tried = static_cast<std::uint16_t>(column->tried | (1u << (voxel.z & 15)));
}

bool CoverageMap::visible(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const {
  const CoverageVoxel first = voxel_at(from);
  bool clear = true;
  walk_voxels(from, to, [&](const CoverageVoxel& v, bool last) {
    clear = last || v == first || !hit(v);
    return clear;
  });
  return clear;
}

double CoverageMap::seen_volume() const {
  int voxels = 0;
  for (const Tile& tile : tiles_)
    for (const Column& column : tile.columns) voxels += std::popcount(column.seen());
  return voxels * kVoxel * kVoxel * kVoxel;
}

std::size_t CoverageMap::memory() const {
  return tiles_.capacity() * sizeof(Tile) + index_.size() * 32 + index_.bucket_count() * sizeof(void*);
}

void CoverageMap::clear() {
  tiles_.clear();
  index_.clear();
  last_ = -1;
}

}  // namespace adit::nav
