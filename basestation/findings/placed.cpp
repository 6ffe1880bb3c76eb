// SPDX-License-Identifier: Apache-2.0
#include "basestation/findings/placed.hpp"

namespace adit::station {

findings::Placed placed(const findings::Finding& finding, const ChunkStore& chunks) {
  if (!finding.anchor) return findings::placed(finding, std::nullopt);
  const findings::Anchor& anchor = *finding.anchor;
  const ChunkStore::Submap* submap = chunks.find({finding.key.robot, anchor.start, anchor.submap});
  return findings::placed(finding, submap ? submap->T_map_submap : std::nullopt);
}

}  // namespace adit::station
