#pragma once
#include <optional>

#include "core/time/time.hpp"

namespace adit {

/// What a thread had of the processor so far, as the system counts it.
struct ProcessorUse {
  Duration ran{};     ///< on a processor
  Duration waited{};  ///< for one, without the wait that has not ended yet
  bool ready{};       ///< runs now, or waits for a processor
};

/// What a strand is, too, that has a thread: one of a rehearsal takes no time, and is not.
class OnProcessor {
 public:
  virtual ~OnProcessor() = default;
  /// From any thread. Nothing when there is no telling.
  virtual std::optional<ProcessorUse> processor_use() const = 0;
};

/// Of a thread of this process, from any thread. Nothing when it has ended, or when the system counts
/// nothing.
std::optional<ProcessorUse> processor_use(int thread_id);

/// Of `passed`, the time between two looks at a thread, what it cannot lay to the lack of a processor: what
/// it ran when it still wants to, else (it is blocked) all that it did not wait for a processor.
Duration answerable(const ProcessorUse& before, const ProcessorUse& now, Duration passed);

}  // namespace adit
