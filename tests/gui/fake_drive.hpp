// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "basestation/gui/bridge/drive_sink.hpp"

namespace adit::gui {

/// Takes sticks and stops instead of a station, and remembers them. Any thread.
class FakeDrive : public DriveSink {
 public:
  std::shared_ptr<const station::World> world() const override {
    const std::lock_guard guard(mutex_);
    return world_;
  }
  double silent_for() const override { return silent; }
  std::int64_t drive(const std::string& robot, Done done) override {
    const Change change(*this);
    robots_.push_back(robot);
    done_ = std::move(done);
    return static_cast<std::int64_t>(robots_.size());
  }
  void stick(std::int64_t drive, const station::StickVelocity& velocity) override {
    const Change change(*this);
    last_ = velocity;
    last_of_[drive] = velocity;
    last_drive_ = drive;
    ++sticks_;
  }
  void cancel(std::int64_t drive) override {
    const Change change(*this);
    cancelled_.push_back(drive);
  }
  void halt(const std::vector<std::string>& robots) override {
    const Change change(*this);
    halts_.push_back(robots.empty() ? "all" : robots.front());
  }
  void show(const station::World& world) {
    const std::lock_guard guard(mutex_);
    world_ = std::make_shared<station::World>(world);
  }
  station::StickVelocity last() const {
    const std::lock_guard guard(mutex_);
    return last_;
  }
  std::int64_t last_drive() const {
    const std::lock_guard guard(mutex_);
    return last_drive_;
  }
  std::vector<std::string> robots() const {
    const std::lock_guard guard(mutex_);
    return robots_;
  }
  std::vector<std::string> halts() const {
    const std::lock_guard guard(mutex_);
    return halts_;
  }
  std::size_t cancelled() const {
    const std::lock_guard guard(mutex_);
    return cancelled_.size();
  }
  Done done() const {
    const std::lock_guard guard(mutex_);
    return done_;
  }
  /// Of that drive, counted from 1.
  station::StickVelocity last_of(std::int64_t drive) const {
    const std::lock_guard guard(mutex_);
    const auto found = last_of_.find(drive);
    return found == last_of_.end() ? station::StickVelocity{} : found->second;
  }
  int sticks() const {
    const std::lock_guard guard(mutex_);
    return sticks_;
  }
  /// Waits until that holds of this sink; false after 5 s.
  bool wait(const std::function<bool()>& holds) const {
    const auto give_up = std::chrono::system_clock::now() + std::chrono::seconds(5);
    while (!holds()) {
      std::unique_lock guard(mutex_);
      changed_.wait_until(guard,
                          std::min(give_up, std::chrono::system_clock::now() + std::chrono::milliseconds(5)));
      if (std::chrono::system_clock::now() > give_up) return false;
    }
    return true;
  }
  bool wait_for_speed(double vx) const {
    return wait([&] { return sticks() > 0 && std::abs(last().vx - vx) < 1e-3; });
  }
  std::atomic<double> silent{0.0};

 private:
  struct Change {
    explicit Change(FakeDrive& sink) : sink_(sink), guard_(sink.mutex_) {}
    ~Change() { sink_.changed_.notify_all(); }
    FakeDrive& sink_;
    std::lock_guard<std::mutex> guard_;
  };
  mutable std::condition_variable changed_{};
  mutable std::mutex mutex_{};
  std::shared_ptr<const station::World> world_{std::make_shared<station::World>()};
  std::vector<std::string> robots_{}, halts_{};
  std::vector<std::int64_t> cancelled_{};
  station::StickVelocity last_{};
  std::map<std::int64_t, station::StickVelocity> last_of_{};
  std::int64_t last_drive_{};
  int sticks_{};
  Done done_{};
};

}  // namespace adit::gui
