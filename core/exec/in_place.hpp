// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/exec/executor.hpp"

namespace adit {

/// A strand for which another thread can run a task. A thread that receives data thus need not wake the
/// strand's own thread, but spends the time of the task.
class InPlace {
 public:
  virtual ~InPlace() = default;
  /// Runs the task at once on the calling thread; no other task of the strand runs meanwhile. Returns false
  /// without running it when the strand is busy, has queued posts, or has ended. Safe to call from any thread
  /// except the strand's own.
  virtual bool try_run(const Task& task) = 0;
};

}  // namespace adit
