#pragma once
#include <functional>
#include <string>
#include <vector>

#include "core/time/time.hpp"

namespace adit::agent {

struct ParentParams {
  std::string program{"/proc/self/exe"};  ///< the executable of the child
  std::vector<std::string> command{};     ///< its arguments, its name first
  Duration zero_period{50ms};             ///< of the zeros while no agent lives
  Duration first_restart{20ms};           ///< pause before a restart; four times as long at each next
  Duration longest_restart{10s};
  Duration good_run{10s};  ///< a child that lived so long starts the pauses anew
  Duration patience{5s};   ///< from SIGTERM to SIGKILL
  Duration start{30s};     ///< a child that does not command the driver after so long is killed
  Duration pulse{3s};      ///< a child that was silent for so long hangs, and is killed
};

/// The descriptor in the child on which it reports: a byte from when it sends commands itself, and then again
/// and again while it lives.
inline constexpr int kReportFd = 3;
/// With this code the agent ends itself to be started anew: a component hangs, or fails for good.
inline constexpr int kEscalatedExit = 70;

/// Runs the agent as a child and outlives it: `send_zero` is called from the moment the child dies, every
/// period, until a new one has reported that it commands the driver itself (rule 6). A child that hangs is
/// killed. SIGINT and SIGTERM,
/// which must be blocked by the caller, are passed on. Returns when told to end, or when the child ended by
/// itself or with exit code 2 (wrong usage, which a restart does not mend): the child's exit code.
///
/// `prepare` is called once the first child runs: what it opens is not inherited by that child.
class Parent {
 public:
  Parent(ParentParams params, std::function<void()> prepare, std::function<void()> send_zero);
  int run();

 private:
  bool spawn();
  int wait_for_end();
  int reap();
  void hear();
  void rest(Duration pause);

  ParentParams params_;
  std::function<void()> prepare_;
  std::function<void()> send_zero_;
  int signals_{-1};
  int child_{-1}, pidfd_{-1}, report_{-1};
  bool prepared_{}, commands_{}, ending_{};
  std::chrono::steady_clock::time_point heard_{};
};

}  // namespace adit::agent
