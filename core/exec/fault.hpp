#pragma once
#include "core/exec/executor.hpp"

/// Faults for tests and rehearsals. No product code uses this header beyond the components' fault injection.
namespace adit {

/// Does not return: a fault, called in a task of that very strand. Live the thread
/// blocks until the process ends. In rehearsal the task's stack stays where it is, too, and the scheduler
/// goes on on another thread; when the scheduler is destroyed, the task is unwound by HangReleased.
/// Throws std::logic_error when a strand of a rehearsal is not running this task, or when the executor is no
/// strand of a runtime.
[[noreturn]] void hang(Executor& strand);

/// Ends a task that hung, at the scheduler's destruction. Code that catches everything lets it pass;
/// current_exception_text() does.
struct HangReleased {};

/// Implemented by the strands whose task can hang.
class CanHang {
 public:
  virtual ~CanHang() = default;
  /// Never returns to the task that called it.
  virtual void block() = 0;
};

}  // namespace adit
