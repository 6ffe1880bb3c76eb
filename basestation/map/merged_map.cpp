// SPDX-License-Identifier: Apache-2.0
#include "basestation/map/merged_map.hpp"

namespace adit::station {

std::vector<MapPart> parts_of(const ChunkStore& chunks, const std::string& robot) {
  std::vector<MapPart> out;
  for (const auto& [name, from] : chunks.robots()) {
    if (!robot.empty() && name != robot) continue;
    for (const auto& [key, submap] : from.submaps) {
      if (!submap.T_map_submap || submap.blocks.empty()) continue;
      MapPart part{*submap.T_map_submap, {}};
      part.blocks.reserve(submap.blocks.size());
      for (const auto& [index, block] : submap.blocks)
        part.blocks.push_back({index, block.known, block.occupied});
      out.push_back(std::move(part));
    }
  }
  return out;
}

perception::VoxelImage merged(const std::vector<MapPart>& parts, const perception::VoxelImage* prior,
                              double resolution) {
  perception::VoxelImage image(resolution);
  if (prior != nullptr) image.add(*prior);
  for (const MapPart& part : parts) image.add(part.T_map_submap, part.blocks);
  return image;
}

}  // namespace adit::station
