// SPDX-License-Identifier: Apache-2.0
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
  explicit HeldStrand(std::shared_ptr<Executor> inner)
      : HeldStrand(inner, std::make_shared<Held>(inner->inbox())) {}

  /// Posts that wait.
  std::size_t waiting() const { return held_->waiting(); }
  /// Runs everything that waits, and from now on each post at once, on the strand inside.
  void release() { held_->release(); }

  const std::string& name() const override { return inner_->name(); }
  Time now() const override { return inner_->now(); }
  Timer after(Duration delay, Task task) override { return inner_->after(delay, std::move(task)); }
  Timer every(Duration period, Task task) override { return inner_->every(period, std::move(task)); }

 private:
  class Held final : public Inbox {
   public:
    explicit Held(std::shared_ptr<Inbox> inner) : inner_(std::move(inner)) {}
    std::size_t waiting() const {
      const std::lock_guard lock(mutex_);
      return tasks_.size();
    }
    void release() {
      std::deque<Task> tasks;
      {
        const std::lock_guard lock(mutex_);
        released_ = true;
        tasks.swap(tasks_);
      }
      for (Task& task : tasks) inner_->post_control(std::move(task));
    }

   private:
    bool add(Task task, bool /*control*/) override {
      {
        const std::lock_guard lock(mutex_);
        if (!released_) {
          tasks_.push_back(std::move(task));
          return true;
        }
      }
      return inner_->post_control(std::move(task));
    }
    std::shared_ptr<Inbox> inner_;
    mutable std::mutex mutex_{};
    std::deque<Task> tasks_{};
    bool released_{};
  };

  HeldStrand(std::shared_ptr<Executor> inner, std::shared_ptr<Held> held)
      : Executor(held), inner_(std::move(inner)), held_(std::move(held)) {}
  JobHandle submit(JobSpec, JobWork, JobDone) override { return {}; }

  std::shared_ptr<Executor> inner_;
  std::shared_ptr<Held> held_;
};

}  // namespace adit::wire
