// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "core/wire/participant.hpp"

namespace adit::sim {

using Cdr = std::vector<std::uint8_t>;

/// A sample on its way from the wire to an agent.
struct Arrival {
  const wire::TopicInfo* topic{};  ///< The agent's reader of that topic gets it.
  Cdr cdr{};
  wire::SampleInfo info{};
  Duration delay{};  ///< It is handed over so much later; `info.received` is what the agent sees.
};

/// Changes what one agent hears and says. It stands between the agent and its wires, behind the point where
/// the checker listens: the checker sees what truly arrived and what truly left.
///
/// All calls come from the strands of one machine of a rehearsal, one at a time.
class Interceptor {
 public:
  virtual ~Interceptor() = default;
  Interceptor() = default;
  Interceptor(const Interceptor&) = delete;
  Interceptor& operator=(const Interceptor&) = delete;

  /// The samples that the agent receives instead of `arrival`, in this order.
  virtual std::vector<Arrival> received(Arrival arrival);
  /// The samples that leave on that topic instead of `cdr`.
  virtual std::vector<Cdr> sent(const wire::TopicInfo& topic, Cdr cdr);
};

}  // namespace adit::sim
