// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "basestation/map/chunk_store.hpp"

namespace adit::station {

/// Height of the floor at a place of the map frame, m: the middle of an occupied voxel of 0.2 m with two free
/// ones above it. Of several floors it is the one nearest to the height `near`, m. Nothing: no robot saw a
/// floor there.
std::optional<double> floor_height(const ChunkStore& chunks, double x, double y, double near);

}  // namespace adit::station
