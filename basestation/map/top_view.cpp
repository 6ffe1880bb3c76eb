// SPDX-License-Identifier: Apache-2.0
#include "basestation/map/top_view.hpp"

#include <algorithm>
#include <cmath>

namespace adit::station {
namespace {

constexpr double kMaxExtent = 5000.0;  // m
constexpr double kMaxCells = 50e6;
constexpr double kLow = 0.45;   // m: more than ground that lies between two voxels
constexpr double kHigh = 0.75;  // m
constexpr double kFlat = 0.5;   // m: a map of a planar lidar is not thicker

}  // namespace

TopView::TopView(const perception::VoxelImage& image) : resolution_(image.resolution()) {
  using perception::Voxel, perception::VoxelIndex;
  const auto bounds = image.bounds();
  if (!bounds) return;
  const VoxelIndex low = bounds->low, high = bounds->high;
  const double width = (static_cast<double>(high.x) - low.x + 1) * resolution_,
               depth = (static_cast<double>(high.y) - low.y + 1) * resolution_;
  if (width > kMaxExtent || depth > kMaxExtent || width * depth > kMaxCells * resolution_ * resolution_) {
    too_large_ = true;
    return;
  }
  nx_ = high.x - low.x + 1;
  ny_ = high.y - low.y + 1;
  low_ = Eigen::Vector2d(low.x, low.y) * resolution_;
  cells_.resize(static_cast<std::size_t>(nx_) * static_cast<std::size_t>(ny_));
  const bool flat = (static_cast<double>(high.z) - low.z + 1) * resolution_ <= kFlat;
  const auto cell_of = [&](const VoxelIndex& index) -> Cell& {
    return cells_[static_cast<std::size_t>(index.y - low.y) * static_cast<std::size_t>(nx_) +
                  static_cast<std::size_t>(index.x - low.x)];
  };
  image.for_each([&](const VoxelIndex& index, Voxel) { cell_of(index).kind = Kind::ground; });
  // Voxels of one column follow each other from below: a run goes on when the one below was occupied, too.
  VoxelIndex last{};
  int run = 0;
  for (const VoxelIndex& index : image.occupied()) {
    const bool on_top = run > 0 && index == VoxelIndex{last.x, last.y, last.z + 1};
    run = on_top ? run + 1 : 1;
    last = index;
    Cell& cell = cell_of(index);
    cell.height = static_cast<std::uint8_t>(std::clamp<int>(std::max<int>(cell.height, run), 0, 255));
    if (flat || run * resolution_ > kHigh)
      cell.kind = Kind::high;
    else if (run * resolution_ > kLow && cell.kind != Kind::high)
      cell.kind = Kind::low;
  }
  for (Cell& cell : cells_) {
    if (cell.kind == Kind::ground) cell.height = 0;
    if (flat && cell.kind == Kind::high) cell.height = 10;
  }
}

}  // namespace adit::station
