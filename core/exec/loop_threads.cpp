// SPDX-License-Identifier: Apache-2.0
#include "core/exec/loop_threads.hpp"

#include <utility>

#include "core/exec/fault.hpp"

namespace adit {

LoopThreads::~LoopThreads() { release(); }

bool LoopThreads::run(const std::function<void()>& loop) {
  std::unique_lock lock(mutex_);
  if (!worker_) {
    worker_ = std::make_unique<Worker>();
    worker_->thread = std::thread([this, worker = worker_.get()] { work(*worker); });
  }
  Worker& worker = *worker_;
  worker.loop = &loop;
  worker.changed.notify_all();
  worker.changed.wait(lock, [&] { return !worker.loop || worker.hangs; });
  if (worker.hangs) {
    hung_.push_back(std::move(worker_));
    return false;
  }
  if (const auto failure = std::exchange(worker.failure, nullptr)) std::rethrow_exception(failure);
  return true;
}

void LoopThreads::hang() {
  std::unique_lock lock(mutex_);
  Worker& worker = *worker_;
  worker.hangs = true;
  worker.changed.notify_all();
  worker.changed.wait(lock, [&] { return worker.released; });
  throw HangReleased{};
}

void LoopThreads::work(Worker& worker) {
  std::unique_lock lock(mutex_);
  for (;;) {
    worker.changed.wait(lock, [&] { return worker.loop || worker.released; });
    if (worker.released) return;
    const auto& loop = *worker.loop;
    lock.unlock();
    try {
      loop();
    } catch (const HangReleased&) {
      return;
    } catch (...) {
      worker.failure = std::current_exception();
    }
    lock.lock();
    worker.loop = nullptr;
    worker.changed.notify_all();
  }
}

void LoopThreads::end(Worker& worker) {
  {
    const std::lock_guard lock(mutex_);
    worker.released = true;
    worker.changed.notify_all();
  }
  worker.thread.join();
}

void LoopThreads::release() {
  for (auto& worker : hung_) end(*worker);
  hung_.clear();
  if (worker_) end(*worker_);
  worker_.reset();
}

}  // namespace adit
