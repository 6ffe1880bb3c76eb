// SPDX-License-Identifier: Apache-2.0
#include "basestation/map/floor_height.hpp"

#include <cmath>
#include <cstdint>
#include <map>

namespace adit::station {
namespace {

constexpr double kVoxelEdge = perception::CoarseBlock::kVoxel;
constexpr int kBlockEdge = perception::CoarseBlock::kEdge;

/// The known voxels of one column of a submap, by their height in voxels; true: occupied.
std::map<int, bool> column_of(const ChunkStore::Submap& submap, int x, int y) {
  const auto block_of = [](int voxel) {
    return static_cast<std::int32_t>(std::floor(static_cast<double>(voxel) / kBlockEdge));
  };
  std::map<int, bool> column;
  const std::int32_t bx = block_of(x), by = block_of(y);
  const int in_x = x - bx * kBlockEdge, in_y = y - by * kBlockEdge;
  const perception::BlockIndex lowest{bx, by, -perception::BlockIndex::kLimit};
  for (auto at = submap.blocks.lower_bound(lowest);
       at != submap.blocks.end() && at->first.x == bx && at->first.y == by; ++at) {
    const perception::CoarseBlock block{at->first, at->second.known, at->second.occupied};
    for (int z = 0; z < kBlockEdge; ++z)
      if (const auto voxel = block.at(in_x, in_y, z); voxel != perception::Voxel::unknown)
        column[at->first.z * kBlockEdge + z] = voxel == perception::Voxel::occupied;
  }
  return column;
}

}  // namespace

std::optional<double> floor_height(const ChunkStore& chunks, double x, double y, double near) {
  std::optional<double> best;
  for (const auto& [name, robot] : chunks.robots())
    for (const auto& [key, submap] : robot.submaps) {
      if (!submap.T_map_submap) continue;
      // Submaps are level to a few degrees: one column of them is upright enough.
      const Eigen::Vector3d in_map(x, y, submap.T_map_submap->position.z());
      const Eigen::Vector3d at = submap.T_map_submap->inverse() * in_map;
      constexpr double kFar = perception::BlockIndex::kLimit * double{perception::BlockIndex::kSize};
      if (!(std::abs(at.x()) < kFar && std::abs(at.y()) < kFar)) continue;
      const auto column = column_of(submap, static_cast<int>(std::floor(at.x() / kVoxelEdge)),
                                    static_cast<int>(std::floor(at.y() / kVoxelEdge)));
      const auto is_free = [&](int z) {
        const auto voxel = column.find(z);
        return voxel != column.end() && !voxel->second;
      };
      for (const auto& [z, occupied] : column) {
        if (!occupied || !is_free(z + 1) || !is_free(z + 2)) continue;
        const double height =
            (*submap.T_map_submap * Eigen::Vector3d(at.x(), at.y(), (z + 0.5) * kVoxelEdge)).z();
        if (!best || std::abs(height - near) < std::abs(*best - near)) best = height;
      }
    }
  return best;
}

}  // namespace adit::station
