// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "basestation/fleet/views.hpp"

namespace adit::station {

/// Computes rates from a participant's counters.
class TrafficMeter {
 public:
  /// Returns bytes/s and samples/s since the previous reading; zero at the first one.
  TrafficView read(const std::string& agent, const wire::WireCounters& counters,
                   const wire::SenderState& sender, Time now);

 private:
  wire::WireCounters last_{};
  Time last_at_{};
  bool started_{false};
};

}  // namespace adit::station
