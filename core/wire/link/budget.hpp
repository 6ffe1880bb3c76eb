#pragma once
#include <array>
#include <cstddef>

#include "core/time/time.hpp"
#include "core/wire/link.hpp"

namespace adit::wire {

/// What each may use of a sender's airtime, (0, 1]; over `memory` seconds in the mean. Small messages that a
/// robot obeys are not limited; maps and pictures never get all, so that others' frames find a gap.
struct Budget {
  std::array<double, kPriorities> share{1.0, 0.7, 0.5, 0.5, 0.6, 0.6, 0.3};
  double memory{0.5};  ///< airtime that a class may save up while it is silent, s times its share
};

/// How long a message may wait for the air. What is repaired when it is lost, discovery, `status` and `bulk`,
/// may wait longer: dropping it costs a repair, and nobody waits behind it.
inline Duration max_queue_age(const LinkProfile& link, int priority) {
  const bool can_wait = priority == 1 || priority == 4 || priority == 5;
  return from_seconds(can_wait ? 4.0 * link.queue : link.queue);
}

}  // namespace adit::wire
