// SPDX-License-Identifier: Apache-2.0
#include "core/findings/placed.hpp"

#include "core/findings/stairs_data.hpp"

namespace adit::findings {

Placed placed(const Finding& finding, const std::optional<Pose3>& T_map_submap) {
  if (!finding.anchor || !T_map_submap) return {finding.position};
  const Anchor& anchor = *finding.anchor;
  const Eigen::Vector3d place =
      *T_map_submap * Eigen::Vector3d(anchor.offset[0], anchor.offset[1], anchor.offset[2]);
  return {{place.x(), place.y(), place.z()}, wrap_angle(T_map_submap->yaw() - double{anchor.yaw})};
}

Result<Staircase> stairs_of(const Finding& finding, const Placed& now) {
  auto stairs = stairs_of(finding);
  if (!stairs) return stairs;
  stairs->foot = {now.position[0], now.position[1], now.position[2]};
  stairs->heading = wrap_angle(stairs->heading + now.turn);
  return stairs;
}

}  // namespace adit::findings
