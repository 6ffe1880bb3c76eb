// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "basestation/map/chunk_store.hpp"

namespace adit::station {

/// Ground that robots saw: columns of 0.2 m of which anything is known. The age of a place is the time since
/// this station received its newest part.
struct GroundArea {
  double m2{};
  double within_10s{}, within_1min{}, within_10min{};  ///< Shares by age, [0, 1].
  double unknown{};                                    ///< The share from before this start of the station.
};

/// The ground that a robot saw, or all of them together ("").
GroundArea ground_area(const ChunkStore& chunks, Time now, const std::string& robot = {});

}  // namespace adit::station
