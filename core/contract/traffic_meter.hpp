// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>

#include "core/contract/link.hpp"
#include "core/wire/participant.hpp"

namespace adit::contract {

/// Computes an agent's report of its traffic from the counters of its participant.
class TrafficMeter {
 public:
  /// `first`: the time that the first reading is assumed to cover; 0: its rates are 0.
  explicit TrafficMeter(Duration first = {}) : first_(first) {}

  /// Returns the rates since the previous reading, all topics, and the state of the sender; without peers and
  /// state rate. The rate of a counter that fell is 0.
  LinkReport read(const std::string& agent, const wire::WireCounters& counters,
                  const wire::SenderState& sender, Time now);

 private:
  Duration first_;
  wire::WireCounters last_{};
  std::optional<Time> last_at_{};
};

}  // namespace adit::contract
