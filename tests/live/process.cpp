// SPDX-License-Identifier: Apache-2.0
#include "tests/live/process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <stdlib.h>
#include <sys/file.h>
#include <sys/timerfd.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "tests/folders/folders.hpp"

extern char** environ;

namespace adit::live {
namespace {

using SteadyClock = std::chrono::steady_clock;

std::string program(const std::string& name) {
  return name.find('/') == std::string::npos ? program_folder() + "/" + name : name;
}

/// False at end of file.
bool drain(int fd, std::string& into) {
  char buffer[4096];
  for (;;) {
    const ssize_t n = read(fd, buffer, sizeof buffer);
    if (n > 0) {
      into.append(buffer, static_cast<std::size_t>(n));
    } else {
      return n < 0 && (errno == EAGAIN || errno == EINTR);
    }
  }
}

}  // namespace

double patience() {
  static const double factor = [] {
    const char* text = getenv("ADIT_PATIENCE");
    return text != nullptr ? std::stod(text) : 10.0;
  }();
  return factor;
}

int max_measurements() { return patience() > 1.0 ? 8 : 1; }

Process::Process(std::vector<std::string> arguments, std::map<std::string, std::string> environment) {
  int out[2], err[2];
  if (pipe2(out, O_CLOEXEC) != 0 || pipe2(err, O_CLOEXEC) != 0) throw std::runtime_error("pipe2 failed");
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, out[1], 1);
  posix_spawn_file_actions_adddup2(&actions, err[1], 2);

  std::vector<std::string> variables;
  for (char** e = environ; *e != nullptr; ++e) {
    const std::string entry = *e;
    if (!environment.contains(entry.substr(0, entry.find('=')))) variables.push_back(entry);
  }
  for (const auto& [key, value] : environment) variables.push_back(key + "=" + value);
  arguments[0] = program(arguments[0]);
  std::vector<char*> argv, envp;
  for (auto& a : arguments) argv.push_back(a.data());
  for (auto& v : variables) envp.push_back(v.data());
  argv.push_back(nullptr);
  envp.push_back(nullptr);

  const int failed = posix_spawn(&pid_, argv[0], &actions, nullptr, argv.data(), envp.data());
  posix_spawn_file_actions_destroy(&actions);
  close(out[1]);
  close(err[1]);
  out_fd_ = out[0];
  err_fd_ = err[0];
  if (failed != 0) throw std::runtime_error("cannot start " + arguments[0] + ": " + std::strerror(failed));
  fcntl(out_fd_, F_SETFL, O_NONBLOCK);
  fcntl(err_fd_, F_SETFL, O_NONBLOCK);
}

Process::Process(Process&& other) noexcept
    : pid_(other.pid_),
      out_fd_(other.out_fd_),
      err_fd_(other.err_fd_),
      reaped_(other.reaped_),
      status_(other.status_),
      out_(std::move(other.out_)),
      err_(std::move(other.err_)) {
  other.pid_ = -1;
  other.out_fd_ = other.err_fd_ = -1;
}

Process::~Process() {
  if (pid_ > 0 && !reaped_) {
    kill(pid_, SIGKILL);
    reap(true);
  }
  if (out_fd_ >= 0) close(out_fd_);
  if (err_fd_ >= 0) close(err_fd_);
}

void Process::reap(bool block) {
  if (!reaped_ && waitpid(pid_, &status_, block ? 0 : WNOHANG) == pid_) reaped_ = true;
}

bool Process::running() {
  reap(false);
  return !reaped_;
}

void Process::signal(int number) {
  if (running()) kill(pid_, number);
}

bool Process::pump(Seconds limit) {
  pollfd fds[2] = {{out_fd_, POLLIN, 0}, {err_fd_, POLLIN, 0}};
  poll(fds, 2, static_cast<int>(limit.count() * 1e3));
  const bool out_open = drain(out_fd_, out_);
  const bool err_open = drain(err_fd_, err_);
  return out_open || err_open;
}

bool Process::wait_until(const std::function<bool()>& condition, Seconds limit) {
  const auto end = SteadyClock::now() + limit * patience();
  for (;;) {
    if (condition()) return true;
    if (SteadyClock::now() > end) return false;
    if (!pump(Seconds(0.05)) && !running()) return condition();
  }
}

bool Process::wait_for_output(const std::string& text, Seconds limit) {
  return wait_until(
      [&] { return out_.find(text) != std::string::npos || err_.find(text) != std::string::npos; }, limit);
}

Finished Process::wait(Seconds limit) {
  const auto end = SteadyClock::now() + limit * patience();
  while (running() && SteadyClock::now() < end) {
    // Once both pipes are closed poll returns at once: wait on a timer instead.
    if (!pump(Seconds(0.02))) pass(Seconds(0.01));
  }
  if (running()) {
    kill(pid_, SIGKILL);
    reap(true);
  }
  pump(Seconds(0));
  Finished finished{0, out_, err_};
  finished.exit_code = WIFEXITED(status_) ? WEXITSTATUS(status_) : -WTERMSIG(status_);
  return finished;
}

Finished run(std::vector<std::string> arguments, std::map<std::string, std::string> environment,
             Seconds limit) {
  return Process(std::move(arguments), std::move(environment)).wait(limit);
}

bool eventually(const std::function<bool()>& condition, Seconds limit) {
  const auto end = SteadyClock::now() + limit * patience();
  while (!condition()) {
    if (SteadyClock::now() > end) return false;
    pass(Seconds(0.01));
  }
  return true;
}

void pass(Seconds time) {
  const int fd = timerfd_create(CLOCK_MONOTONIC, TFD_CLOEXEC);
  itimerspec spec{};
  spec.it_value.tv_sec = static_cast<time_t>(time.count());
  spec.it_value.tv_nsec = static_cast<long>((time.count() - std::floor(time.count())) * 1e9);
  timerfd_settime(fd, 0, &spec, nullptr);
  pollfd p{fd, POLLIN, 0};
  while (poll(&p, 1, -1) < 0 && errno == EINTR) continue;
  close(fd);
}

Folder::Folder() : path_(scratch_folder()) {}

Folder::~Folder() {
  std::error_code ignored;  // a leftover file in the temporary folder fails no test
  std::filesystem::remove_all(path_, ignored);
}

std::string Folder::write(const std::string& name, const std::string& text) const {
  const std::string file = path_ + "/" + name;
  std::ofstream(file) << text;
  return file;
}

std::map<std::string, std::string> Folder::environment() const {
  return {{"XDG_RUNTIME_DIR", path_}, {"XDG_STATE_HOME", path_}, {"HOME", path_}};
}

Domains::Domains() {
  // Below 100, so that DDS ports stay under the range from which the kernel draws ephemeral ones; without the
  // radio's default domain.
  std::vector<unsigned> groups;
  for (unsigned first = 10; first < 100; first += kCount)
    if (first != 75) groups.push_back(first);
  const auto offset = static_cast<std::size_t>(getpid()) % groups.size();
  std::rotate(groups.begin(), groups.begin() + static_cast<long>(offset), groups.end());
  const auto take = [&] {
    for (const unsigned first : groups) {
      const std::string name = "adit-domains-" + std::to_string(first) + ".lock";
      const auto path = std::filesystem::temp_directory_path() / name;
      const int file = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
      if (file < 0) continue;  // another user's
      if (flock(file, LOCK_EX | LOCK_NB) == 0) {
        first_ = first;
        lock_ = file;
        return true;
      }
      close(file);
    }
    return false;
  };
  if (!eventually(take, Seconds(30))) throw std::runtime_error("all DDS domains for tests are taken");
}

Domains::~Domains() { close(lock_); }

unsigned domain(unsigned index) {
  static const Domains domains;
  if (index >= Domains::kCount)
    throw std::out_of_range("a process has " + std::to_string(Domains::kCount) + " domains");
  return domains.first() + index;
}

}  // namespace adit::live
