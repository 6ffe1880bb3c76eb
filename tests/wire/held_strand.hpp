#pragma once
#include <deque>
#include <memory>
#include <mutex>
#include <utility>

#include "core/exec/executor.hpp"

namespace adit::wire {

/// A strand that is busy: it holds back what is posted to it until release(). Any thread.
class HeldStrand final : public Executor {
 public:
  explicit HeldStrand(std::shared_ptr<Executor> inner) : inner_(std::move(inner)) {}

  /// Posts that wait.
  std::size_t waiting() const {
    const std::lock_guard lock(mutex_);
    return tasks_.size();
  }
  /// Runs everything that waits, and from now on each post at once, on the strand inside.
  void release() {
    std::deque<Task> tasks;
    {
      const std::lock_guard lock(mutex_);
      released_ = true;
      tasks.swap(tasks_);
    }
    for (Task& task : tasks) inner_->post(std::move(task));
  }

  const std::string& name() const override { return inner_->name(); }
  Time now() const override { return inner_->now(); }
  void post(Task task) override {
    {
      const std::lock_guard lock(mutex_);
      if (!released_) {
        tasks_.push_back(std::move(task));
        return;
      }
    }
    inner_->post(std::move(task));
  }
  Timer after(Duration delay, Task task) override { return inner_->after(delay, std::move(task)); }
  Timer every(Duration period, Task task) override { return inner_->every(period, std::move(task)); }
  void compute(Duration modelled, Task work, Task done) override {
    inner_->compute(modelled, std::move(work), std::move(done));
  }
  void end() override { inner_->end(); }
  void abandon() override { inner_->abandon(); }

 private:
  void block() override {}
  std::shared_ptr<Executor> inner_;
  mutable std::mutex mutex_{};
  std::deque<Task> tasks_{};
  bool released_{};
};

}  // namespace adit::wire
