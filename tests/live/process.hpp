// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <sys/types.h>

#include <chrono>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace adit::live {

using Seconds = std::chrono::duration<double>;

/// How many times longer than on an idle machine an event may take: 10, or ADIT_PATIENCE. The limits of the
/// functions below and of the tests hold for an idle machine and are stretched by it, so that a verdict
/// depends on what happens and not on what else the machine does. `./run test long` runs the live tests once
/// more with 1.
double patience();

/// How often a duration is measured, at most, until it is within the limit of an idle machine: 8, or 1 with a
/// patience of 1. Load lengthens a duration and nothing shortens it: the shortest of some meets the limit on
/// a busy machine too, unless the program became slower.
int max_measurements();

/// What a finished program left.
struct Finished {
  int exit_code{-1};  ///< Negative: killed by that signal.
  std::string out{};
  std::string err{};
};

/// A program of this build running beside the test; killed and reaped when dropped.
class Process {
 public:
  /// `arguments[0]` is a path, or the name of a program in the build's bin folder.
  Process(std::vector<std::string> arguments, std::map<std::string, std::string> environment = {});
  ~Process();
  Process(Process&&) noexcept;
  Process& operator=(Process&&) = delete;

  pid_t pid() const { return pid_; }
  bool running();
  void signal(int number);
  /// Waits for the end; kills it after `limit`, stretched (exit_code is then -SIGKILL).
  Finished wait(Seconds limit);
  /// Reads its output until `condition` holds, which is asked again after each output and every 50 ms; false
  /// after `limit`, stretched, or at its end.
  bool wait_until(const std::function<bool()>& condition, Seconds limit);
  /// The same until `text` has been seen on stdout or stderr.
  bool wait_for_output(const std::string& text, Seconds limit);
  const std::string& out() const { return out_; }
  const std::string& err() const { return err_; }

 private:
  bool pump(Seconds limit);
  void reap(bool block);

  pid_t pid_{-1};
  int out_fd_{-1}, err_fd_{-1};
  bool reaped_{false};
  int status_{0};
  std::string out_{}, err_{};
};

/// Runs a program to its end.
Finished run(std::vector<std::string> arguments, std::map<std::string, std::string> environment = {},
             Seconds limit = Seconds(20));

/// Asks again until `condition` holds; waits on a timer between two asks. False after `limit`, stretched.
bool eventually(const std::function<bool()>& condition, Seconds limit = Seconds(10));

/// Lets that much time pass.
void pass(Seconds time);

/// A folder that goes with the test, for sockets, identities and files.
class Folder {
 public:
  Folder();
  ~Folder();
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  const std::string& path() const { return path_; }
  /// Writes a file below it and returns its path.
  std::string write(const std::string& name, const std::string& text) const;
  /// The environment that keeps every program of a test inside this folder.
  std::map<std::string, std::string> environment() const;

 private:
  std::string path_;
};

/// Five DDS domains in a row that no other process of this machine uses at the same time, as long as it takes
/// them here, too (the demo does): a lock in the temporary folder, which ends with the process.
class Domains {
 public:
  static constexpr unsigned kCount = 5;
  /// Waits while all are taken.
  Domains();
  ~Domains();
  Domains(const Domains&) = delete;
  Domains& operator=(const Domains&) = delete;
  unsigned first() const { return first_; }

 private:
  unsigned first_{};
  int lock_{-1};
};

/// One of this process's own domains; `index` distinguishes several, [0, 4].
unsigned domain(unsigned index = 0);

}  // namespace adit::live
