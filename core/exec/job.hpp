// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <type_traits>
#include <utility>

#include "core/result/result.hpp"
#include "core/time/time.hpp"

namespace adit {

/// Order in which a pool takes queued jobs. It has no effect in rehearsal, where no job waits for a thread.
enum class JobPriority : std::uint8_t { high, normal, low };

/// The threads that run a job: computations, or disk I/O, so that a slow disk delays no computation.
enum class PoolKind : std::uint8_t { compute, io };

/// Description of a computation passed to Executor::compute.
struct JobSpec {
  std::string name{"job"};  ///< Used in reports, and for `latest_only`.
  Duration modelled{};      ///< Duration in rehearsal, from its start, >= 0.
  /// Time from submission to completion; 0: no limit. A later result is dropped, and the completion carries
  /// no_answer at the deadline. A result exactly at the deadline counts.
  Duration deadline{};
  /// Live: work that runs for longer, excluding waits for a processor, counts as hung. It is reported, its
  /// completion carries no_answer, and the pool gets another thread. It does not apply to a
  /// Runtime::dedicated_strand, which the supervisor watches. [100 ms, 1 h]
  Duration watchdog{10s};
  JobPriority priority{JobPriority::normal};
  PoolKind pool{PoolKind::compute};
  /// Jobs of one lane of a strand run one at a time, in the order of submission; "": in parallel. In
  /// rehearsal a job begins when the one before it completes in modelled time.
  std::string lane{};
  /// Replaces a job of the same name and lane that has not begun; the completion of the replaced job carries
  /// `cancelled`. Without a lane the name is the lane.
  bool latest_only{false};
};

/// A job in progress, as its executor controls it.
class JobControl {
 public:
  virtual ~JobControl() = default;
  virtual void cancel() = 0;
};

/// Handle of a job; destroying it changes nothing.
class JobHandle {
 public:
  JobHandle() = default;
  explicit JobHandle(std::weak_ptr<JobControl> control) : control_(std::move(control)) {}
  /// Cancels the job; call it on the job's strand. Unless the job has completed, its completion carries
  /// `cancelled` and its work does not begin; live, the stop token of running work is triggered.
  void cancel() const {
    if (const auto control = control_.lock()) control->cancel();
  }

 private:
  std::weak_ptr<JobControl> control_{};
};

using JobWork = std::function<void(std::stop_token)>;
using JobDone = std::function<void(Result<void>)>;

/// Calls work with or without a stop token.
template <class Work>
decltype(auto) run_work(Work& work, std::stop_token stop) {
  if constexpr (std::is_invocable_v<Work&, std::stop_token>)
    return work(std::move(stop));
  else
    return work();
}

template <class R>
struct JobValue {
  using type = R;
};
template <class T>
struct JobValue<Result<T>> {
  using type = T;
};
/// Value type of the completion's Result: T for work that returns T or Result<T>.
template <class Work>
using job_value_t =
    typename JobValue<decltype(run_work(std::declval<Work&>(), std::declval<std::stop_token>()))>::type;

}  // namespace adit
