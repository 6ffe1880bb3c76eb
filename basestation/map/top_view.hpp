// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "perception/map/voxel_image.hpp"

namespace adit::station {

/// A map seen from above: for each column of voxels, what it means for who drives there.
class TopView {
 public:
  enum class Kind : std::uint8_t { unknown, ground, low, high };
  struct Cell {
    Kind kind{};
    std::uint8_t height{};  ///< Voxels of the tallest thing in the column.
  };

  /// Occupied voxels on top of each other: up to 0.45 m count as ground or ceiling, up to 0.75 m as a low
  /// thing, more as a wall. A map of one height, of a planar lidar, has walls only.
  explicit TopView(const perception::VoxelImage& image);

  int nx() const { return nx_; }
  int ny() const { return ny_; }
  double resolution() const { return resolution_; }
  const Eigen::Vector2d& low() const { return low_; }  ///< Corner of the cell (0, 0), m.
  const Cell& at(int x, int y) const { return cells_[static_cast<std::size_t>(y) * nx_ + x]; }
  /// Whether the map is too large for a view.
  bool too_large() const { return too_large_; }

 private:
  int nx_{}, ny_{};
  double resolution_{};
  Eigen::Vector2d low_{0, 0};
  std::vector<Cell> cells_{};
  bool too_large_{false};
};

}  // namespace adit::station
