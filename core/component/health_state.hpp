// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>

#include "core/time/time.hpp"

namespace adit {

/// Health of a component as its watchers see it.
struct ComponentHealth {
  std::string name{};
  bool running{false};
  /// It runs, its heart beats, and there was no failure in the last HealthParams::failure_memory.
  bool healthy{false};
  Duration beat_age{0};  ///< Time since its loop last ran the heartbeat.
  std::uint64_t heartbeats{0};
  std::uint64_t failures{0};
  std::string last_failure{};  ///< Text of the newest exception, "" when there was none.
};

/// Periods of the heartbeat and of the memory of failures.
struct HealthParams {
  Duration beat{200ms};          ///< Period of the heartbeat, [1 ms, 10 s].
  Duration silence{1s};          ///< Time without a heartbeat after which it is unhealthy.
  Duration failure_memory{10s};  ///< Time after a failure during which it is unhealthy.
};

/// The health of a component. It is written on the component's strand, read from any thread, and outlives the
/// component.
class HealthState {
 public:
  HealthState(std::string name, HealthParams params) : name_(std::move(name)), params_(params) {}
  const std::string& name() const { return name_; }
  const HealthParams& params() const { return params_; }

  void started(Time now) {
    last_beat_.store(now.time_since_epoch().count(), std::memory_order_relaxed);
    running_.store(true, std::memory_order_release);
  }
  void stopped() { running_.store(false, std::memory_order_release); }
  void beat(Time now) {
    last_beat_.store(now.time_since_epoch().count(), std::memory_order_relaxed);
    heartbeats_.fetch_add(1, std::memory_order_relaxed);
  }
  void failed(Time now, const std::string& text) {
    const std::lock_guard lock(mutex_);
    ++failures_;
    last_failure_at_ = now;
    last_failure_ = text;
  }

  /// `now`: by the clock of the component's machine.
  ComponentHealth health(Time now) const {
    ComponentHealth h;
    h.name = name_;
    h.running = running_.load(std::memory_order_acquire);
    h.heartbeats = heartbeats_.load(std::memory_order_relaxed);
    h.beat_age = now - Time(Duration(last_beat_.load(std::memory_order_relaxed)));
    const std::lock_guard lock(mutex_);
    h.failures = failures_;
    h.last_failure = last_failure_;
    const bool failed_lately = failures_ > 0 && now - last_failure_at_ < params_.failure_memory;
    h.healthy = h.running && h.beat_age <= params_.silence && !failed_lately;
    return h;
  }

 private:
  std::string name_;
  HealthParams params_;
  std::atomic<bool> running_{false};
  std::atomic<std::int64_t> last_beat_{0};
  std::atomic<std::uint64_t> heartbeats_{0};
  mutable std::mutex mutex_{};  // Guards the members below; only failures and watchers lock it.
  std::uint64_t failures_{0};
  Time last_failure_at_{};
  std::string last_failure_{};
};

}  // namespace adit
