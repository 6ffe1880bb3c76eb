// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstddef>
#include <optional>

#include "core/time/time.hpp"

namespace adit::agent {

/// The rate of a robot's beacons: 2 Hz, 1 Hz on links below 500 kbit/s, and 5 Hz in a convoy, but no more
/// than a share of the link. Without another robot in reach none is sent.
class BeaconRate {
 public:
  /// Size of a beacon on the wire, an upper bound, bytes.
  static constexpr double kBytes = 320.0;
  /// Share of the link's bandwidth for beacons, and the same in a convoy, whose members go first.
  static constexpr double kShare = 0.1, kConvoyShare = 0.2;

  /// @param bandwidth  Of the link, bit/s; 0: unlimited.
  /// @param robots  Other robots that are present: each of them is sent its own copy.
  /// Returns the rate, Hz; 0: none is sent.
  static double rate(double bandwidth, std::size_t robots, bool in_convoy) {
    constexpr double kThin = 500e3;  // bit/s
    if (robots == 0) return 0.0;
    const bool thin = bandwidth > 0.0 && bandwidth < kThin;
    const double wanted = in_convoy ? 5.0 : thin ? 1.0 : 2.0;
    if (bandwidth <= 0.0) return wanted;
    const double share = in_convoy ? kConvoyShare : kShare;
    return std::min(wanted, share * bandwidth / (8.0 * kBytes * static_cast<double>(robots)));
  }

  /// Whether a beacon is due; if so, it counts as sent. Call it every `tick`.
  bool due(double rate, Time now, Duration tick) {
    if (rate <= 0.0 || (sent_ && now - *sent_ < from_seconds(1.0 / rate) - tick / 2)) return false;
    sent_ = now;
    return true;
  }

 private:
  std::optional<Time> sent_{};
};

}  // namespace adit::agent
