// SPDX-License-Identifier: Apache-2.0
#include "core/exec/job_pool.hpp"

#include "core/exec/failure.hpp"

namespace adit {

JobPool::JobPool(int threads) {
  for (int i = 0; i < threads; ++i) threads_.emplace_back([this] { loop(); });
}

JobPool::~JobPool() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  added_.notify_all();
  for (auto& thread : threads_) thread.join();
}

void JobPool::add(std::shared_ptr<Job> job) {
  {
    const std::lock_guard lock(mutex_);
    queue_.insert(std::move(job));
  }
  if (!threads_.empty()) added_.notify_one();
}

void JobPool::run(std::shared_ptr<Job> job, std::unique_lock<std::mutex>& lock) {
  queue_.erase(job);
  job->state = Job::State::running;
  lock.unlock();
  try {
    job->work();
  } catch (...) {
    job->failed = true;
    job->failure = current_exception_text();
  }
  job->work = nullptr;  // The captures of the work are destroyed here, outside the lock.
  lock.lock();
  job->state = Job::State::finished;
  finished_.notify_all();
}

void JobPool::finish(const std::shared_ptr<Job>& job) {
  std::unique_lock lock(mutex_);
  if (job->state == Job::State::queued) {
    run(job, lock);
    return;
  }
  while (job->state != Job::State::finished) {
    if (!queue_.empty()) {
      run(*queue_.begin(), lock);
    } else {
      finished_.wait(lock);
    }
  }
}

void JobPool::forget(const std::shared_ptr<Job>& job) {
  const std::lock_guard lock(mutex_);
  if (job->state == Job::State::queued) queue_.erase(job);
}

void JobPool::loop() {
  std::unique_lock lock(mutex_);
  for (;;) {
    added_.wait(lock, [this] { return stopping_ || !queue_.empty(); });
    if (stopping_) return;
    run(*queue_.begin(), lock);
  }
}

}  // namespace adit
