// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "basestation/map/chunk_store.hpp"
#include "core/findings/placed.hpp"

namespace adit::station {

/// Places a finding by its submap's pose, as far as that came here.
findings::Placed placed(const findings::Finding& finding, const ChunkStore& chunks);

}  // namespace adit::station
