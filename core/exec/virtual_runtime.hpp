// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "core/exec/executor.hpp"
#include "core/exec/failure.hpp"

namespace adit {

/// Called with the processor time of a task, or of a computation by its name; a task has the name "".
using OnUse = std::function<void(const std::string& strand, const std::string& job, Duration used)>;

struct VirtualParams {
  std::uint64_t seed{1};  ///< Seed of the order in which machines run that have events at the same instant.
  int workers{2};         ///< Threads that do `compute` work, the calling one included, [1, 64].
  /// Largest number of tasks at one instant; beyond it run_until() throws.
  std::uint64_t max_per_instant{50'000'000};
  FailureHandler on_failure{report_on_stderr};
  OnUse on_use{};  ///< Called on the thread that did the work. Empty: nothing is measured.
};

/// A seeded discrete-event scheduler for all machines of a rehearsal. While the caller of run_until waits, a
/// single thread runs every task in the order of virtual time; tasks of one machine at the same instant run
/// in the order in which they were posted, and machines with work at the same instant in an order drawn from
/// the seed. A task takes no virtual time. `compute` work runs in parallel but completes at its modelled
/// time, so the same seed gives the same run on any computer. Between runs all calls are made on the caller's
/// thread.
///
/// Posting to a strand from inside `compute` work is an error (std::logic_error, reported as a failure of
/// that work). An exception of such work is reported at its completion time.
class VirtualScheduler {
 public:
  explicit VirtualScheduler(VirtualParams params);
  explicit VirtualScheduler(std::uint64_t seed);
  ~VirtualScheduler();
  VirtualScheduler(const VirtualScheduler&) = delete;
  VirtualScheduler& operator=(const VirtualScheduler&) = delete;

  /// Creates a machine whose clock shows virtual time plus `clock_offset`. The machine and its strands may
  /// outlive the scheduler; nothing then runs on them.
  std::unique_ptr<Runtime> machine(std::string name, Duration clock_offset);
  /// Advances a machine's clock by `by` at once, also on its existing strands. Its timers are not affected:
  /// they wait for elapsed time. Throws std::logic_error for another kind of machine.
  void jump_clock(Runtime& machine, Duration by);
  /// Runs the task once virtual time has reached `when` (at once when that is past), on a strand of the
  /// simulated world: faults, scripts, measurements.
  void at(Duration when, Task task);

  /// Runs all events due up to and including `when`; afterwards elapsed() == when. Throws std::runtime_error
  /// when tasks post each other for ever while time stands still.
  void run_until(Duration when);
  /// Virtual time since construction.
  Duration elapsed() const;
  /// Tasks run so far.
  std::uint64_t tasks_run() const;
  /// Exceptions thrown by tasks or work so far; each was reported to on_failure.
  std::uint64_t failures() const;
  /// Number of tasks that hang, each on its own thread (core/exec/fault.hpp). They end with the scheduler.
  std::size_t hung() const;

  struct State;  // Shared with the strands; private to virtual_runtime.cpp.

 private:
  std::shared_ptr<State> core_;
  std::unique_ptr<Runtime> world_;
  std::shared_ptr<Strand> world_strand_;
};

}  // namespace adit
