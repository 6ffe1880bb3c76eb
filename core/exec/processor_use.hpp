// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "core/time/time.hpp"

namespace adit {

/// Processor time of a thread so far, as the system counts it.
struct ProcessorUse {
  Duration ran{};     ///< Time on a processor.
  Duration waited{};  ///< Time waiting for a processor, without the current wait.
  bool ready{};       ///< Runs now, or waits for a processor.
};

/// Interface of a strand with a thread of its own. Strands of a rehearsal take no time and do not implement
/// it.
class OnProcessor {
 public:
  virtual ~OnProcessor() = default;
  /// Safe to call from any thread. Nothing when the system does not count it.
  virtual std::optional<ProcessorUse> processor_use() const = 0;
};

/// Time that the calling thread spent on a processor so far.
Duration own_processor_time();

/// Processor use of a thread of this process; safe to call from any thread. Nothing when the thread has ended
/// or the system does not count it.
std::optional<ProcessorUse> processor_use(int thread_id);

/// The part of `passed`, the time between two readings of a thread, that does not come from a lack of
/// processors: the time it ran if it is still ready to run, else (it is blocked) all time in which it did not
/// wait for a processor.
Duration answerable(const ProcessorUse& before, const ProcessorUse& now, Duration passed);

}  // namespace adit
