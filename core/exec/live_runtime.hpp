// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "core/exec/executor.hpp"
#include "core/exec/failure.hpp"

namespace adit {

struct LiveParams {
  /// Length of a strand's queue, [1, 1e6]; further posts are dropped, counted and reported.
  std::size_t queue{4096};
  int compute_threads{1};          ///< [1, 16], of low priority. Disk I/O has a separate thread.
  std::size_t compute_queue{256};  ///< Length of the job queue per pool, and per worker strand, [1, 1e6].
  int compute_nice{5};             ///< Nice value of compute threads and workers, [0, 19].
  Duration shutdown{2s};           ///< How long the runtime's destructor waits for running jobs, [0, 60 s].
  FailureHandler on_failure{report_on_stderr};  ///< Called on the thread concerned: must be thread safe.
};

/// Runtime on the real clock (steady_clock) with a thread per strand. Destroying a strand drops its queued
/// tasks, waits for the running one and joins the thread. Strands may outlive the runtime; their jobs are
/// then cancelled.
class LiveRuntime final : public Runtime {
 public:
  explicit LiveRuntime(LiveParams params = {});
  /// Waits for running jobs, at most LiveParams::shutdown; the thread of a job that hangs is abandoned.
  ~LiveRuntime() override;
  /// The thread carries the first 15 characters of the name.
  std::shared_ptr<Strand> strand(const std::string& name) override;
  std::shared_ptr<Strand> dedicated_strand(const std::string& name) override;
  /// Exceptions thrown by tasks or jobs so far.
  std::uint64_t failures() const;
  /// Posts and jobs dropped so far because a queue was full.
  std::uint64_t dropped() const;
  /// Abandoned threads: of strands so far (also when their task has returned), and of jobs that hang now.
  std::uint64_t left_behind() const;

  struct Shared;  // Private to the implementation.

 private:
  std::shared_ptr<Shared> shared_;
};

}  // namespace adit
