#pragma once
#include "core/exec/executor.hpp"

namespace adit {

/// A strand for which another thread can run a task. It saves a thread that receives data the wake-up of the
/// strand's own one, and costs it the time that the task takes.
class InPlace {
 public:
  virtual ~InPlace() = default;
  /// Runs the task at once on the calling thread; no other task of the strand runs meanwhile. False, and
  /// nothing ran, when the strand is busy, has posts that wait, or ended. Any thread but the strand's own.
  virtual bool try_run(const Task& task) = 0;
};

}  // namespace adit
