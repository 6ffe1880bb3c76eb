#pragma once
#include <map>
#include <optional>
#include <string>

#include "adit/link.h"
#include "core/wire/participant.hpp"

namespace adit::agent {

/// Turns the wire's counters into rates. Included by .cpp files only.
class LinkMeter {
 public:
  /// Rates since the last call; since the start of the wire for the first one, which is taken as 1 s.
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
