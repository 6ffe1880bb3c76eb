// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "basestation/map/chunk_store.hpp"
#include "perception/map/voxel_image.hpp"

namespace adit::station {

/// One submap as a value, for work on another thread.
struct MapPart {
  Pose3 T_map_submap{};
  std::vector<perception::CoarseBlock> blocks{};
  bool newest{};                          ///< Of its robot.
  std::vector<std::uint32_t> received{};  ///< Of each block, as ChunkStore::Block.
};

/// The submaps of that robot, or of all, whose pose is known; of each robot the oldest first.
std::vector<MapPart> parts_of(const ChunkStore& chunks, const std::string& robot = {});

/// One map in the map frame. What the newest part of a robot shows occupied counts twice: it is the merge of
/// many submaps, and another robot that saw free space there from afar does not erase it alone. `prior`: what
/// was known before, which shows where no robot saw anything; may be null. `resolution`: edge of a voxel, m.
perception::VoxelImage merged(const std::vector<MapPart>& parts, const perception::VoxelImage* prior,
                              double resolution);

}  // namespace adit::station
