#pragma once
#include "core/exec/executor.hpp"

namespace adit {

/// Does not return: a fault for tests and rehearsals, called in a task of that very strand. Live the thread
/// blocks until the process ends. In rehearsal the task's stack stays where it is, too, and the scheduler
/// goes on on another thread; when the scheduler is destroyed, the task is unwound by HangReleased.
/// Throws std::logic_error when a strand of a rehearsal is not running this task.
[[noreturn]] void hang(Executor& strand);

/// Ends a task that hung, at the scheduler's destruction. Whoever catches everything lets it pass;
/// current_exception_text() does.
struct HangReleased {};

}  // namespace adit
