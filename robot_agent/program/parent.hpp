// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "core/time/time.hpp"

namespace adit::agent {

struct ParentParams {
  std::string program{"/proc/self/exe"};  ///< Executable of the child.
  std::vector<std::string> command{};     ///< Arguments of the child, its name first.
  std::vector<std::string> at_first{};    ///< Further arguments of each child until one has reported.
  Duration zero_period{50ms};             ///< Period of the zero velocities while no agent is running.
  Duration first_restart{20ms};  ///< Pause before a restart; four times as long before each further one.
  Duration longest_restart{10s};
  Duration good_run{10s};  ///< After a child ran for this long, the pauses start again at `first_restart`.
  Duration patience{5s};   ///< From SIGTERM to SIGKILL.
  Duration start{30s};     ///< A child that does not command the driver within this time is killed.
  Duration pulse{3s};      ///< A child that was silent for this long hangs, and is killed.
};

/// File descriptor on which the child reports: it writes a byte when it starts to send commands itself, and
/// repeats that while it is alive.
inline constexpr int kReportFd = 3;
/// Exit code with which the agent requests a restart: a component hangs, or cannot be restarted.
inline constexpr int kEscalatedExit = 70;

/// Runs the agent as a child process and restarts it. `send_zero` is called from the moment the child dies,
/// every period, until a new child has reported that it commands the driver itself (rule 6). A child that
/// hangs is killed.
///
/// SIGINT and SIGTERM, which the caller must block, are passed on to the child. After such a signal run()
/// returns 0. It also returns when the child ends by itself with code 0 or 2 (wrong usage, which a restart
/// does not fix), with that code, and with 1 when no child can be started.
///
/// `prepare` is called once the first child runs: that child does not inherit the descriptors that it opens.
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
  bool prepared_{}, commands_{}, has_commanded_{}, ending_{};
  std::chrono::steady_clock::time_point heard_{};
};

}  // namespace adit::agent
