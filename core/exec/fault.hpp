// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/exec/executor.hpp"

/// Faults for tests and rehearsals. In the product, only the components' fault injection uses this header.
namespace adit {

/// Never returns: a fault, called in a task of that strand. Live, the thread blocks until the process ends.
/// In rehearsal the stack of the task is preserved and the scheduler continues on another thread; when the
/// scheduler is destroyed, HangReleased unwinds the task. Throws std::logic_error when a strand of a
/// rehearsal is not running this task, or when the executor is no strand of a runtime.
[[noreturn]] void hang(Executor& strand);

/// Exception that ends a hung task when the scheduler is destroyed. Code that catches all exceptions must
/// rethrow it; current_exception_text() does.
struct HangReleased {};

/// Interface of strands whose task can hang.
class CanHang {
 public:
  virtual ~CanHang() = default;
  /// Blocks the calling task; never returns.
  virtual void block() = 0;
};

}  // namespace adit
