// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/contract/team.hpp"
#include "core/time/time.hpp"

namespace adit::agent {

using contract::ConvoyPart;
using contract::TeamBeacon;
using contract::YieldAnswer;
using contract::YieldAsk;

/// The last beacon of a peer, and when it arrived by this robot's clock.
struct HeardBeacon {
  TeamBeacon beacon{};
  Time at{};
  Duration period{1s};  ///< Time between its beacons, without the lost ones.
};

/// Reason to refuse a beacon.
enum class BeaconFault : std::uint8_t {
  none,
  malformed,  ///< A number that is not finite or out of range, an invalid name, too many entries.
  unknown,    ///< No robot of that name is known, or another participant is bound to the name.
  old,        ///< A newer beacon of that robot arrived before it.
};

/// Number of refused beacons since the start, by reason.
struct BeaconFaults {
  std::uint64_t malformed{}, unknown{}, old{};
  std::uint64_t total() const { return malformed + unknown + old; }
  void count(BeaconFault fault) {
    malformed += fault == BeaconFault::malformed ? 1 : 0;
    unknown += fault == BeaconFault::unknown ? 1 : 0;
    old += fault == BeaconFault::old ? 1 : 0;
  }
};

}  // namespace adit::agent
