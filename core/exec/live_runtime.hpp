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
  std::size_t queue{4096};  ///< Posts waiting per strand, [1, 1e6]; more are dropped, counted and reported.
  int compute_threads{1};   ///< [1, 16], of low priority. Disk I/O has one of its own.
  std::size_t compute_queue{256};  ///< Jobs waiting per pool, and per worker strand, [1, 1e6].
  int compute_nice{5};             ///< Nice value of compute threads and workers, [0, 19].
  Duration shutdown{2s};           ///< How long the runtime's end waits for jobs that run, [0, 60 s].
  FailureHandler on_failure{report_on_stderr};  ///< Called on the thread concerned: must be thread safe.
};

/// The real clock (steady_clock) and a thread per strand. Dropping a strand joins its thread; queued tasks
/// are dropped, one that runs is waited for. Strands may outlive the runtime; their jobs are cancelled then.
class LiveRuntime final : public Runtime {
 public:
  explicit LiveRuntime(LiveParams params = {});
  /// Waits for jobs that run, at most LiveParams::shutdown: the thread of one that hangs is left behind.
  ~LiveRuntime() override;
  /// The thread carries the first 15 characters of the name.
  std::shared_ptr<Strand> strand(const std::string& name) override;
  std::shared_ptr<Strand> dedicated_strand(const std::string& name) override;
  /// Exceptions that left a task or a job so far.
  std::uint64_t failures() const;
  /// Posts and jobs dropped so far because a queue was full.
  std::uint64_t dropped() const;
  /// Threads left behind: of strands so far, one whose task returned included, and of jobs that hang now.
  std::uint64_t left_behind() const;

  struct Shared;  // private to the implementation

 private:
  std::shared_ptr<Shared> shared_;
};

}  // namespace adit
