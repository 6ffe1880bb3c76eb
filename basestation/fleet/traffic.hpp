#pragma once
#include "basestation/fleet/views.hpp"

namespace adit::station {

/// Turns a wire's counters into rates since the last reading.
class TrafficMeter {
 public:
  /// Bytes and samples a second since the reading before; zero rates at the first one.
  TrafficView read(const std::string& agent, const wire::WireCounters& counters,
                   const wire::SenderState& sender, Time now);

 private:
  wire::WireCounters last_{};
  Time last_at_{};
  bool started_{false};
};

}  // namespace adit::station
