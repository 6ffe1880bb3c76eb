// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <condition_variable>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace adit {

/// Runs a loop on a separate thread while the caller waits. A task of the loop that hangs keeps that thread,
/// and the next run gets another one: at any time one thread works and the others are blocked.
class LoopThreads {
 public:
  LoopThreads() = default;
  ~LoopThreads();
  LoopThreads(const LoopThreads&) = delete;
  LoopThreads& operator=(const LoopThreads&) = delete;

  /// Returns true when the loop returned, false when it hangs. Rethrows exceptions of the loop.
  bool run(const std::function<void()>& loop);
  /// Blocks this thread until release(), then throws HangReleased. Called inside the loop.
  [[noreturn]] void hang();
  /// Ends all threads one after another; hung loops are unwound.
  void release();
  /// Number of loops that hang.
  std::size_t hung() const { return hung_.size(); }

 private:
  struct Worker {
    const std::function<void()>* loop{nullptr};  ///< The loop to run; null: nothing.
    bool hangs{false};
    bool released{false};
    std::exception_ptr failure{};
    std::condition_variable changed{};
    std::thread thread{};
  };
  void work(Worker& worker);
  void end(Worker& worker);

  std::mutex mutex_{};
  std::unique_ptr<Worker> worker_{};
  std::vector<std::unique_ptr<Worker>> hung_{};
};

}  // namespace adit
