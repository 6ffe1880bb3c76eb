// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "core/result/result.hpp"
#include "perception/map/submap_grid.hpp"
#include "perception/map/voxel_image.hpp"

namespace adit::bench {

/// Blocks as a robot would send them together: those that changed while it drove a few metres.
using BlockBatch = std::vector<perception::FineBlock>;

/// What one drive through a world gave.
struct MapDrive {
  std::string world{};
  std::vector<BlockBatch> batches{};
  perception::SubmapGrid grid{};  ///< The whole of it, at 0.1 m.
};

/// A robot with a lidar of 16 x 900 beams that drives `length` m through a generated world (kind and seed)
/// or, "geb079", through that building, and turns at random where it cannot go on.
Result<MapDrive> drive_through(std::string_view world, std::uint64_t seed, double length);

/// The map geb079.bt, resampled to voxels of 0.1 m.
Result<perception::VoxelImage> building_map();
/// Its blocks.
std::vector<perception::FineBlock> fine_blocks(const perception::VoxelImage& image);
/// All blocks of a grid.
std::vector<perception::FineBlock> fine_blocks(const perception::SubmapGrid& grid);

}  // namespace adit::bench
