// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <optional>
#include <string>

#include "adit/link.h"
#include "core/wire/participant.hpp"

namespace adit::agent {

/// Computes rates from the participant's counters. Included by .cpp files only.
class LinkMeter {
 public:
  /// Returns the rates since the last call. The first call counts from the start of the participant and
  /// assumes 1 s.
  radio::LinkReport report(const wire::WireCounters& counters, const wire::SenderState& sender,
                           const std::string& agent, Time now);

 private:
  struct Sums {
    std::uint64_t samples_out{}, bytes_out{}, samples_in{}, bytes_in{};
  };
  std::map<std::string, Sums> last_{};
  wire::WireCounters totals_{};
  std::optional<Time> at_{};
};

}  // namespace adit::agent
