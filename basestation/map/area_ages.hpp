// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "basestation/map/chunk_store.hpp"

namespace adit::station {

/// How old the map is, as shares of its area, [0, 1]. The age of a place is the time since this station
/// received its newest part.
struct AreaAges {
  double within_10s{}, within_1min{}, within_10min{};
  double unknown{};  ///< From before this start of the station.
};

AreaAges area_ages(const ChunkStore& chunks, Time now);

}  // namespace adit::station
