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

/// Which waiting job a pool takes first. In rehearsal nothing waits for a thread, so it has no effect there.
enum class JobPriority : std::uint8_t { high, normal, low };

/// The threads that run a job: computations, or disk I/O, so that a slow disk holds up no computation.
enum class PoolKind : std::uint8_t { compute, io };

/// A computation that a component hands to Executor::compute.
struct JobSpec {
  std::string name{"job"};  ///< In reports, and for `latest_only`.
  Duration modelled{};      ///< What it takes in rehearsal, from its begin, >= 0.
  /// From submission to completion; 0: none. A result that comes later is dropped, and the completion carries
  /// no_answer at the deadline. A result that is due exactly then counts.
  Duration deadline{};
  /// Live: work that runs for longer, waits for a processor apart, counts as hung. It is reported, its
  /// completion carries no_answer, and the pool gets another thread. Not on a Runtime::dedicated_strand,
  /// where the supervisor watches. [100 ms, 1 h]
  Duration watchdog{10s};
  JobPriority priority{JobPriority::normal};
  PoolKind pool{PoolKind::compute};
  /// Jobs of one lane of a strand run one at a time, in the order of submission; "": beside each other. In
  /// rehearsal the next one begins when the one before it completes in modelled time.
  std::string lane{};
  /// A job of the same name and lane that has not begun is replaced; its completion carries `cancelled`.
  /// Without a lane the name is the lane.
  bool latest_only{false};
};

/// A job under way, as its executor sees it.
class JobControl {
 public:
  virtual ~JobControl() = default;
  virtual void cancel() = 0;
};

/// A handle of a job; dropping it changes nothing.
class JobHandle {
 public:
  JobHandle() = default;
  explicit JobHandle(std::weak_ptr<JobControl> control) : control_(std::move(control)) {}
  /// On the job's strand. Unless the job has completed, its completion carries `cancelled`, its work does not
  /// begin, and live the stop token of work that runs is triggered.
  void cancel() const {
    if (const auto control = control_.lock()) control->cancel();
  }

 private:
  std::weak_ptr<JobControl> control_{};
};

using JobWork = std::function<void(std::stop_token)>;
using JobDone = std::function<void(Result<void>)>;

/// Calls work that takes a stop token, or none.
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
/// What the completion of such work carries in its Result: T for work that returns T or Result<T>.
template <class Work>
using job_value_t =
    typename JobValue<decltype(run_work(std::declval<Work&>(), std::declval<std::stop_token>()))>::type;

}  // namespace adit
