// SPDX-License-Identifier: Apache-2.0
#include "perception/stairs/surface_cells.hpp"

#include <cmath>

namespace adit::perception {

void SurfaceCells::build(std::span<const Eigen::Vector3f> points, const Eigen::Vector3f& centre) {
  constexpr std::size_t columns = static_cast<std::size_t>(kSide) * kSide;
  heights_.assign(columns, {});
  first_.assign(columns + 1, 0);
  cells_.clear();
  runs_.clear();
  const Eigen::Vector3f corner = centre - Eigen::Vector3f(kReach, kReach, kHeight);
  points_.clear();
  places_.clear();
  counts_.assign(columns, 0);
  for (std::size_t n = points.size(); n-- > 0;) {
    const Eigen::Vector3f p = points[n] - corner;
    if (!(p.x() >= 0.0f && p.y() >= 0.0f && p.z() >= 0.0f)) continue;
    if (!(p.x() < 2 * kReach && p.y() < 2 * kReach && p.z() < 2 * kHeight)) continue;
    const int x = std::min(kSide - 1, static_cast<int>(p.x() / kEdge));
    const int y = std::min(kSide - 1, static_cast<int>(p.y() / kEdge));
    const auto column = static_cast<std::size_t>(y * kSide + x);
    if (counts_[column] >= kMostInColumn) continue;
    ++counts_[column];
    const int bin = std::min(kBins - 1, static_cast<int>(p.z() / kBin));
    heights_[column].set(static_cast<std::size_t>(bin));
    points_.push_back(points[n]);
    places_.push_back({static_cast<int>(column), bin});
  }
  for (std::size_t column = 0; column < columns; ++column) {
    first_[column] = cells_.size();
    const std::bitset<kBins>& heights = heights_[column];
    if (heights.none()) continue;
    int begin = -1, last = -1;
    const auto close = [&] {
      if (begin >= 0 && last - begin < kTallest) {
        cells_.push_back({.column = static_cast<int>(column)});
        runs_.push_back({begin, last + 1});
      }
    };
    for (auto bin = heights._Find_first(); bin < kBins; bin = heights._Find_next(bin)) {
      const int at = static_cast<int>(bin);
      if (begin < 0 || at - last > kGap) {
        close();
        begin = at;
      }
      last = at;
    }
    close();
  }
  first_[columns] = cells_.size();
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const auto column = static_cast<std::size_t>(places_[i].column);
    for (std::size_t n = first_[column]; n < first_[column + 1]; ++n)
      if (places_[i].bin >= runs_[n].begin && places_[i].bin < runs_[n].end) {
        cells_[n].mean += points_[i];
        ++cells_[n].count;
      }
  }
  for (SurfaceCell& cell : cells_) cell.mean /= static_cast<float>(cell.count);
}

}  // namespace adit::perception
