// SPDX-License-Identifier: Apache-2.0
#include "perception/stairs/slope_regions.hpp"

#include <algorithm>
#include <cmath>

namespace adit::perception {
namespace {

constexpr int kRadius = 4;                 // Columns: a plane over 0.8 m spans two steps.
constexpr float kOfOneSurface = 0.6f;      // m in height
constexpr std::size_t kLeastForPlane = 8;  // Cells.
constexpr float kLeastSlope = 0.3f, kMostSlope = 1.9f;
constexpr float kRoughest = 0.12f;       // rms from the plane, m: steps of 25 cm have 0.07
constexpr std::size_t kLeastCells = 12;  // Of a region.
constexpr float kSameDirection = 0.87f;  // Cosine of 30 degrees.
constexpr int kNear = 2;                 // Columns between cells of one region.

/// Whether a cell at the distance of the planes' radius lies higher or lower: if none does, the ground is
/// level.
bool is_level(const SurfaceCells& cells, const SurfaceCell& cell) {
  constexpr float level = 0.08f;  // m
  const int x = cell.column % SurfaceCells::kSide, y = cell.column / SurfaceCells::kSide;
  for (const auto& [dx, dy] : {std::pair{kRadius, 0},
                               {-kRadius, 0},
                               {0, kRadius},
                               {0, -kRadius},
                               {3, 3},
                               {3, -3},
                               {-3, 3},
                               {-3, -3}})
    for (const SurfaceCell& other : cells.at(x + dx, y + dy)) {
      const float higher = std::abs(other.mean.z() - cell.mean.z());
      if (higher > level && higher < 2 * kOfOneSurface) return false;
    }
  return true;
}

}  // namespace

SlopeRegions::Local SlopeRegions::plane_at(const SurfaceCells& cells, const SurfaceCell& cell) const {
  if (is_level(cells, cell)) return {};
  const int x = cell.column % SurfaceCells::kSide, y = cell.column / SurfaceCells::kSide;
  float n = 0, sx = 0, sy = 0, sz = 0, sxx = 0, sxy = 0, syy = 0, sxz = 0, syz = 0, szz = 0;
  for (int dy = -kRadius; dy <= kRadius; ++dy)
    for (int dx = -kRadius; dx <= kRadius; ++dx)
      for (const SurfaceCell& other : cells.at(x + dx, y + dy)) {
        const Eigen::Vector3f d = other.mean - cell.mean;
        if (std::abs(d.z()) > kOfOneSurface) continue;
        n += 1;
        sx += d.x(), sy += d.y(), sz += d.z();
        sxx += d.x() * d.x(), sxy += d.x() * d.y(), syy += d.y() * d.y();
        sxz += d.x() * d.z(), syz += d.y() * d.z(), szz += d.z() * d.z();
      }
  if (n < kLeastForPlane) return {};
  const float cxx = sxx - sx * sx / n, cxy = sxy - sx * sy / n, cyy = syy - sy * sy / n;
  const float cxz = sxz - sx * sz / n, cyz = syz - sy * sz / n, czz = szz - sz * sz / n;
  const float det = cxx * cyy - cxy * cxy;
  // Cells on one line determine no plane.
  if (det < 0.02f * (cxx + cyy) * (cxx + cyy)) return {};
  const Eigen::Vector2f gradient((cxz * cyy - cyz * cxy) / det, (cyz * cxx - cxz * cxy) / det);
  const float slope = gradient.norm();
  const float rest = (czz - gradient.x() * cxz - gradient.y() * cyz) / n;
  return {gradient, slope > kLeastSlope && slope < kMostSlope && rest < kRoughest * kRoughest};
}

SlopeExtent extent(const SlopeRegion& region, const Eigen::Vector2f& uphill) {
  SlopeExtent out;
  std::vector<float> across;
  for (const Eigen::Vector3f& d : region.cells) {
    const float along = d.head<2>().dot(uphill);
    out.begin = std::min(out.begin, along);
    out.end = std::max(out.end, along);
    across.push_back(uphill.x() * d.y() - uphill.y() * d.x());
  }
  std::sort(across.begin(), across.end());
  if (across.empty()) return out;
  const std::size_t outer = across.size() * 3 / 20;
  out.right = across[outer];
  out.left = across[across.size() - 1 - outer];
  return out;
}

SlopeRegion SlopeRegions::measured(const SurfaceCells& cells) const {
  SlopeRegion region;
  Eigen::Vector2f gradient = Eigen::Vector2f::Zero();
  for (const std::size_t n : members_) {
    region.centre += cells.cells()[n].mean;
    region.slope += locals_[n].gradient.norm();
    gradient += locals_[n].gradient.normalized();
  }
  const auto count = static_cast<float>(members_.size());
  region.centre /= count;
  region.slope /= count;
  region.uphill = gradient.normalized();
  for (const std::size_t n : members_) region.cells.push_back(cells.cells()[n].mean - region.centre);
  return region;
}

const std::vector<SlopeRegion>& SlopeRegions::find(const SurfaceCells& cells) {
  regions_.clear();
  locals_.clear();
  for (const SurfaceCell& cell : cells.cells()) locals_.push_back(plane_at(cells, cell));
  taken_.assign(locals_.size(), 0);
  for (std::size_t seed = 0; seed < locals_.size(); ++seed) {
    if (!locals_[seed].steep || taken_[seed]) continue;
    Eigen::Vector2f uphill = Eigen::Vector2f::Zero();  // Sum of the members'.
    open_.assign(1, seed);
    members_.clear();
    taken_[seed] = 1;
    while (!open_.empty()) {
      const std::size_t from = open_.back();
      open_.pop_back();
      members_.push_back(from);
      uphill += locals_[from].gradient.normalized();
      const SurfaceCell& cell = cells.cells()[from];
      const int x = cell.column % SurfaceCells::kSide, y = cell.column / SurfaceCells::kSide;
      for (int dy = -kNear; dy <= kNear; ++dy)
        for (int dx = -kNear; dx <= kNear; ++dx)
          for (const SurfaceCell& other : cells.at(x + dx, y + dy)) {
            const auto to = static_cast<std::size_t>(&other - cells.cells().data());
            if (taken_[to] || !locals_[to].steep || std::abs(other.mean.z() - cell.mean.z()) > kOfOneSurface)
              continue;
            // Against all members: neighbours alone would lead round corners.
            if (locals_[to].gradient.normalized().dot(uphill.normalized()) < kSameDirection) continue;
            taken_[to] = 1;
            open_.push_back(to);
          }
    }
    if (members_.size() >= kLeastCells) regions_.push_back(measured(cells));
  }
  std::stable_sort(regions_.begin(), regions_.end(), [](const SlopeRegion& a, const SlopeRegion& b) {
    return a.cells.size() > b.cells.size();
  });
  if (regions_.size() > kMostRegions) regions_.resize(kMostRegions);
  return regions_;
}

}  // namespace adit::perception
