// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <ctime>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "core/exec/executor.hpp"

namespace adit::agent {

/// What the tasks of a strand took of the processor, and the names of the computations that they began.
struct StrandUse {
  double longest{};  ///< Of one task, ms of the thread's processor time.
  double sum{};      ///< Of all tasks, ms.
  std::size_t tasks{};
  std::map<std::string, std::size_t> jobs{};

  static double thread_ms() {
    timespec used{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &used);
    return 1e3 * static_cast<double>(used.tv_sec) + 1e-6 * static_cast<double>(used.tv_nsec);
  }
  template <class Work>
  void measure(const Work& work) {
    const double before = thread_ms();
    work();
    const double took = thread_ms() - before;
    longest = std::max(longest, took);
    sum += took;
    ++tasks;
  }
};

/// A strand that measures each of its tasks, timers and completions. For strands of a rehearsal, which all
/// run on one thread.
class TimedStrand final : public Strand {
 public:
  TimedStrand(std::shared_ptr<Strand> inner, std::shared_ptr<StrandUse> use)
      : Strand(std::make_shared<TimedInbox>(inner->inbox(), use)),
        inner_(std::move(inner)),
        use_(std::move(use)) {}

  const std::string& name() const override { return inner_->name(); }
  Time now() const override { return inner_->now(); }
  Timer after(Duration delay, Task task) override {
    return inner_->after(delay, timed(std::move(task), use_));
  }
  Timer every(Duration period, Task task) override {
    return inner_->every(period, timed(std::move(task), use_));
  }
  void end() override { inner_->end(); }
  bool drain(Duration limit) override { return inner_->drain(limit); }
  void abandon() override { inner_->abandon(); }

 private:
  class TimedInbox final : public Inbox {
   public:
    TimedInbox(std::shared_ptr<Inbox> inner, std::shared_ptr<StrandUse> use)
        : inner_(std::move(inner)), use_(std::move(use)) {}

   private:
    bool add(Task task, bool control) override {
      Task measured = timed(std::move(task), use_);
      return control ? inner_->post_control(std::move(measured)) : inner_->post(std::move(measured));
    }
    std::shared_ptr<Inbox> inner_;
    std::shared_ptr<StrandUse> use_;
  };

  static Task timed(Task task, const std::shared_ptr<StrandUse>& use) {
    return [task = std::move(task), use] { use->measure(task); };
  }
  JobHandle submit(JobSpec spec, JobWork work, JobDone done) override {
    ++use_->jobs[spec.name];
    return inner_->compute(
        std::move(spec), [work = std::move(work)](std::stop_token stop) { work(std::move(stop)); },
        [done = std::move(done), use = use_](Result<void> ended) {
          use->measure([&] { done(std::move(ended)); });
        });
  }

  std::shared_ptr<Strand> inner_;
  std::shared_ptr<StrandUse> use_;
};

/// A runtime that measures its strands, by their names.
class TimedRuntime final : public Runtime {
 public:
  explicit TimedRuntime(std::unique_ptr<Runtime> inner) : inner_(std::move(inner)) {}

  std::shared_ptr<Strand> strand(const std::string& name) override {
    return std::make_shared<TimedStrand>(inner_->strand(name), share(name));
  }
  std::shared_ptr<Strand> dedicated_strand(const std::string& name) override {
    return std::make_shared<TimedStrand>(inner_->dedicated_strand(name), share(name));
  }
  StrandUse& use(const std::string& strand) { return *share(strand); }

 private:
  std::shared_ptr<StrandUse> share(const std::string& name) {
    auto& use = uses_[name];
    if (!use) use = std::make_shared<StrandUse>();
    return use;
  }
  std::unique_ptr<Runtime> inner_;
  std::map<std::string, std::shared_ptr<StrandUse>> uses_{};
};

}  // namespace adit::agent
