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
  std::size_t queue{4096};  ///< posts waiting per strand; 1..1e6; more are dropped, counted and reported
  int compute_threads{1};   ///< 1..16, of low priority
  std::size_t compute_queue{256};               ///< work waiting; more is dropped, counted and reported
  int compute_nice{5};                          ///< nice of compute threads and workers, 0..19
  FailureHandler on_failure{report_on_stderr};  ///< called on the thread concerned: must be thread safe
};

/// The real clock (steady_clock) and a thread per strand. Dropping a strand joins its thread; tasks that
/// wait are dropped, one that runs is waited for. Strands may outlive the runtime; their `compute` is
/// dropped and reported then.
class LiveRuntime final : public Runtime {
 public:
  explicit LiveRuntime(LiveParams params = {});
  ~LiveRuntime() override;
  /// The thread carries the first 15 characters of the name.
  std::shared_ptr<Executor> strand(const std::string& name) override;
  std::shared_ptr<Executor> worker(const std::string& name) override;
  /// Exceptions that left a task or work so far.
  std::uint64_t failures() const;
  /// Posts and work dropped so far because a queue was full.
  std::uint64_t dropped() const;
  /// Threads that abandon() left behind so far; one whose task returned ended.
  std::uint64_t left_behind() const;

  struct Shared;  // private to the implementation

 private:
  std::shared_ptr<Shared> shared_;
};

}  // namespace adit
