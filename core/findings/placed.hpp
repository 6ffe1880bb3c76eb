// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <optional>

#include "core/findings/finding.hpp"
#include "core/geometry/pose.hpp"
#include "core/geometry/staircase.hpp"
#include "core/result/result.hpp"

namespace adit::findings {

/// Where a finding is in the map as it is now.
struct Placed {
  std::array<double, 3> position{};  ///< Map frame, m.
  double turn{};  ///< By which the map around it was turned since the robot set its place, rad, (-pi, pi].
};

/// Places a finding by the present pose of the submap that its anchor names. Without an anchor, or without
/// that pose, it stays where its robot set it.
Placed placed(const Finding& finding, const std::optional<Pose3>& T_map_submap);

/// The staircase of a finding at its place of now. Errors: as of stairs_of(const Finding&).
Result<Staircase> stairs_of(const Finding& finding, const Placed& now);

}  // namespace adit::findings
