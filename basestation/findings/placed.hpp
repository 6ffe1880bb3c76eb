// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "basestation/map/chunk_store.hpp"
#include "core/findings/finding.hpp"

namespace adit::station {

/// Where a finding is in the map as it is now.
struct Placed {
  std::array<double, 3> position{};  ///< Map frame, m.
  double turn{};  ///< By which the map around it was turned since the robot set its place, rad, (-pi, pi].
};

/// An anchored finding moves with its submap, as far as the submap's pose came here; another one stays.
Placed placed(const findings::Finding& finding, const ChunkStore& chunks);

}  // namespace adit::station
