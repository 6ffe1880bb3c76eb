// SPDX-License-Identifier: Apache-2.0
#include "basestation/map/merged_map.hpp"

namespace adit::station {

std::vector<MapPart> parts_of(const ChunkStore& chunks, const std::string& robot) {
  std::vector<MapPart> out;
  for (const auto& [name, from] : chunks.robots()) {
    if (!robot.empty() && name != robot) continue;
    const std::size_t before = out.size();
    for (const perception::SubmapKey* key : by_age(from)) {
      const ChunkStore::Submap& submap = from.submaps.at(*key);
      if (!submap.T_map_submap || submap.blocks.empty()) continue;
      MapPart part{*submap.T_map_submap, {}, false};
      part.blocks.reserve(submap.blocks.size());
      part.received.reserve(submap.blocks.size());
      for (const auto& [index, block] : submap.blocks) {
        part.blocks.push_back({index, block.known, block.occupied});
        part.received.push_back(block.received);
      }
      out.push_back(std::move(part));
    }
    if (out.size() > before) out.back().newest = true;
  }
  return out;
}

perception::VoxelImage merged(const std::vector<MapPart>& parts, const perception::VoxelImage* prior,
                              double resolution) {
  perception::VoxelImage image(resolution);
  if (prior != nullptr) image.add(*prior);
  for (const MapPart& part : parts) {
    image.add(part.T_map_submap, part.blocks);
    if (!part.newest) continue;
    std::vector<perception::CoarseBlock> occupied;
    for (const perception::CoarseBlock& block : part.blocks)
      if (block.occupied != 0) occupied.push_back({block.index, block.occupied, block.occupied});
    image.add(part.T_map_submap, occupied);
  }
  return image;
}

}  // namespace adit::station
