#pragma once
#include <cstdint>
#include <memory>
#include <string>

#include "core/exec/executor.hpp"
#include "core/exec/failure.hpp"

namespace adit {

struct VirtualParams {
  std::uint64_t seed{1};  ///< order in which machines run that have something to do at the same instant
  int workers{2};         ///< threads that do `compute` work, the calling one included; 1..64
  std::uint64_t max_per_instant{50'000'000};  ///< tasks without time going on, then run_until throws
  FailureHandler on_failure{report_on_stderr};
};

/// One seeded discrete-event scheduler for all machines of a rehearsal. A single thread, while the caller of
/// run_until waits, runs every task in the order of virtual time; tasks of one machine at the same instant
/// run in the order in which they were posted, machines with work at the same instant in an order drawn from
/// the seed. A task takes no virtual time. `compute` work runs in parallel, but completes at its modelled
/// time, so the same seed gives the same run whatever the machine. Between runs everything is called on the
/// caller's thread.
///
/// Posting to a strand from inside `compute` work is an error (std::logic_error, reported as a failure
/// of that work). When work throws, this is reported at its completion time.
class VirtualScheduler {
 public:
  explicit VirtualScheduler(VirtualParams params);
  explicit VirtualScheduler(std::uint64_t seed);
  ~VirtualScheduler();
  VirtualScheduler(const VirtualScheduler&) = delete;
  VirtualScheduler& operator=(const VirtualScheduler&) = delete;

  /// A machine whose clock shows virtual time plus `clock_offset`. The machine and its strands may
  /// outlive the scheduler; nothing runs on them then.
  std::unique_ptr<Runtime> machine(std::string name, Duration clock_offset);
  /// A machine's clock goes on by `by` at once, also on the strands it has. Its timers run when they would
  /// have run: they wait for time that passes. Throws std::logic_error for another kind of machine.
  void jump_clock(Runtime& machine, Duration by);
  /// Runs the task once virtual time has reached `when` (at once when that is past), on a strand of the
  /// world itself: faults, scripts, measurements.
  void at(Duration when, Task task);

  /// Runs everything due up to and including `when`; afterwards elapsed() == when. Throws
  /// std::runtime_error when tasks post each other for ever without time going on.
  void run_until(Duration when);
  /// Virtual time since construction.
  Duration elapsed() const;
  /// Tasks run so far.
  std::uint64_t tasks_run() const;
  /// Exceptions that left a task or work so far; each was reported to on_failure.
  std::uint64_t failures() const;
  /// Tasks that hang, each on a thread of its own (core/exec/fault.hpp). They end with the scheduler.
  std::size_t hung() const;

  struct State;  // shared with the strands, private to virtual_runtime.cpp

 private:
  std::shared_ptr<State> core_;
  std::unique_ptr<Runtime> world_;
  std::shared_ptr<Strand> world_strand_;
};

}  // namespace adit
