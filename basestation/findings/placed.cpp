// SPDX-License-Identifier: Apache-2.0
#include "basestation/findings/placed.hpp"

#include "core/geometry/pose.hpp"

namespace adit::station {

Placed placed(const findings::Finding& finding, const ChunkStore& chunks) {
  if (!finding.anchor) return {finding.position};
  const findings::Anchor& anchor = *finding.anchor;
  const ChunkStore::Submap* submap = chunks.find({finding.key.robot, anchor.start, anchor.submap});
  if (!submap || !submap->T_map_submap) return {finding.position};
  const Eigen::Vector3d offset(anchor.offset[0], anchor.offset[1], anchor.offset[2]);
  const Eigen::Vector3d place = *submap->T_map_submap * offset;
  return {{place.x(), place.y(), place.z()}, wrap_angle(submap->T_map_submap->yaw() - double{anchor.yaw})};
}

}  // namespace adit::station
