// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>

#include "core/time/time.hpp"
#include "core/wire/link.hpp"

namespace adit::wire {

/// Share of a sender's airtime that each priority may use, (0, 1], averaged over `memory` seconds. Small
/// messages such as commands are not limited; maps and images never get all airtime, so that other senders'
/// frames find a gap.
struct Budget {
  std::array<double, kPriorities> share{1.0, 0.7, 0.5, 0.5, 0.6, 0.6, 0.3};
  double memory{0.5};  ///< Airtime that a class can accumulate while it is silent, s times its share.
};

/// Maximum time that a message is queued. Messages that are repaired when lost, discovery, `status` and
/// `bulk`, may be queued longer: dropping them costs a repair, and no message waits for them.
inline Duration max_queue_age(const LinkProfile& link, int priority) {
  const bool can_wait = priority == 1 || priority == 4 || priority == 5;
  return from_seconds(can_wait ? 4.0 * link.queue : link.queue);
}

}  // namespace adit::wire
