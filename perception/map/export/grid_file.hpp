// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <iosfwd>
#include <string>
#include <vector>

#include "core/result/result.hpp"
#include "perception/map/floors.hpp"
#include "perception/map/voxel_image.hpp"

namespace adit::perception {

/// Heights of obstacles above the ground of their floor, m.
struct HeightBand {
  double low{0.2};
  double high{1.2};
};

/// A plan of one floor, as map_server takes it.
struct FloorPlan {
  double resolution{};                              ///< m
  Eigen::Vector2d origin{Eigen::Vector2d::Zero()};  ///< Corner with the smallest coordinates, map frame, m.
  int width{}, height{};                            ///< Cells.
  std::vector<std::uint8_t> cells{};  ///< kOccupied, kFree or kUnknown, rows from the smallest y up.
  static constexpr std::uint8_t kOccupied = 0, kFree = 254, kUnknown = 205;
};

/// The plan of a floor: a cell is occupied when a voxel within `band` above the ground is. Where no ground
/// was seen, in walls and between the rings of a lidar, that of the nearest column within 2 m holds. Errors:
/// map_empty without a floor, out_of_range for a floor that is none of find_floors(): the text says how many
/// there are.
Result<FloorPlan> floor_plan(const VoxelImage& image, std::size_t floor, const HeightBand& band = {});

/// Writes a PGM image (P5), the largest y first.
Result<void> write_pgm(const FloorPlan& plan, std::ostream& to);
/// Writes the YAML file of map_server; `image` is the PGM file's name.
Result<void> write_map_yaml(const FloorPlan& plan, const std::string& image, std::ostream& to);

}  // namespace adit::perception
