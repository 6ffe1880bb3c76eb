// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/program/parent.hpp"

#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/signalfd.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>

// The header of glibc 2.36 lacks extern "C".
extern "C" {
#include <sys/pidfd.h>
}
extern char** environ;

namespace adit::agent {
namespace {

using Clock = std::chrono::steady_clock;
constexpr Duration kTurn = 100ms;  // Period of the checks of the child.

int milliseconds(Duration d) {
  return static_cast<int>(std::chrono::duration_cast<std::chrono::milliseconds>(d).count());
}

int exit_code(int status) { return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status); }

void close_fd(int& fd) {
  if (fd >= 0) ::close(fd);
  fd = -1;
}

}  // namespace

Parent::Parent(ParentParams params, std::function<void()> prepare, std::function<void()> send_zero)
    : params_(std::move(params)), prepare_(std::move(prepare)), send_zero_(std::move(send_zero)) {}

bool Parent::spawn() {
  int pipe[2];
  if (::pipe2(pipe, O_CLOEXEC) != 0) return false;
  std::vector<std::string> words = params_.command;
  if (!has_commanded_) words.insert(words.end(), params_.at_first.begin(), params_.at_first.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
  posix_spawn_file_actions_init(&actions);
  posix_spawnattr_init(&attributes);
  sigset_t none;
  sigemptyset(&none);
  posix_spawnattr_setsigmask(&attributes, &none);  // The child does not inherit the caller's signal mask.
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
  posix_spawn_file_actions_adddup2(&actions, pipe[1], kReportFd);
  // The child does not inherit the sockets of this process's participant.
  posix_spawn_file_actions_addclosefrom_np(&actions, kReportFd + 1);
  const int failed =
      ::posix_spawn(&child_, params_.program.c_str(), &actions, &attributes, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  ::close(pipe[1]);
  report_ = pipe[0];
  if (failed != 0) {
    std::fprintf(stderr, "robot_agent: cannot start %s: %s\n", params_.program.c_str(),
                 std::strerror(failed));
    close_fd(report_);
    child_ = -1;
    return false;
  }
  pidfd_ = ::pidfd_open(child_, 0);
  return pidfd_ >= 0;
}

int Parent::reap() {
  int status = 0;
  ::waitpid(child_, &status, 0);
  if (prepared_) send_zero_();  // The zero velocity comes first.
  commands_ = false;
  close_fd(pidfd_);
  close_fd(report_);
  child_ = -1;
  return exit_code(status);
}

void Parent::hear() {
  char bytes[64];
  const ssize_t got = ::read(report_, bytes, sizeof bytes);
  if (got <= 0) return close_fd(report_);
  commands_ = has_commanded_ = true;
  heard_ = Clock::now();
}

int Parent::wait_for_end() {
  auto killed_at = Clock::time_point::max();
  heard_ = Clock::now();
  auto turned = heard_;
  for (;;) {
    pollfd wait[3] = {{pidfd_, POLLIN, 0}, {signals_, POLLIN, 0}, {report_, POLLIN, 0}};
    const bool zero = prepared_ && !commands_;
    ::poll(wait, 3, milliseconds(zero ? params_.zero_period : kTurn));
    if (wait[2].revents != 0) hear();  // Also what a child reported just before its end.
    if (wait[0].revents != 0) return reap();
    if (wait[1].revents != 0) {
      signalfd_siginfo info{};
      (void)!::read(signals_, &info, sizeof info);
      ending_ = true;
      ::kill(child_, SIGTERM);
      killed_at = Clock::now() + params_.patience;
    }
    const auto now = Clock::now();
    // While this process got no CPU time, the silence of the child does not count.
    heard_ += std::max(now - turned - 2 * kTurn, Clock::duration{});
    turned = now;
    const bool silent = report_ >= 0 && now - heard_ > (commands_ ? params_.pulse : params_.start);
    if (silent && !ending_) {
      std::fprintf(stderr, "robot_agent: the agent hangs; ending it\n");
      heard_ = now;  // Kills once.
      ::kill(child_, SIGKILL);
    }
    if (now > killed_at) ::kill(child_, SIGKILL);
    if (zero) send_zero_();
  }
}

void Parent::rest(Duration pause) {
  const auto until = Clock::now() + pause;
  while (!ending_ && Clock::now() < until) {
    send_zero_();
    pollfd wait{signals_, POLLIN, 0};
    if (::poll(&wait, 1, milliseconds(params_.zero_period)) > 0) ending_ = true;
  }
}

int Parent::run() {
  sigset_t passed;
  sigemptyset(&passed);
  sigaddset(&passed, SIGINT);
  sigaddset(&passed, SIGTERM);
  signals_ = ::signalfd(-1, &passed, SFD_CLOEXEC);
  Duration pause = params_.first_restart;
  for (;;) {
    const auto started = Clock::now();
    if (!spawn()) return 1;
    if (!prepared_) {
      prepare_();
      prepared_ = true;
    }
    const int code = wait_for_end();
    if (ending_ || code == 0 || code == 2) return ending_ ? 0 : code;
    if (Clock::now() - started > params_.good_run) pause = params_.first_restart;
    std::fprintf(stderr, "robot_agent: the agent ended with %d; sending zero, starting it again in %.2f s\n",
                 code, seconds(pause));
    rest(pause);
    if (ending_) return 0;
    pause = std::min(4 * pause, params_.longest_restart);
  }
}

}  // namespace adit::agent
