// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <type_traits>
#include <vector>

#include "core/exec/live_runtime.hpp"
#include "core/exec/virtual_runtime.hpp"
#include "core/wire/fastdds/fastdds_participant.hpp"
#include "core/wire/memory/simulated_network.hpp"
#include "tests/live/process.hpp"

namespace adit::wire {

/// One small network, by either adapter, so that the same test body runs over both.
class MemoryNet {
 public:
  explicit MemoryNet(const LinkProfile& link = {.latency = 0.0001}) : network_(scheduler_, {.link = link}) {}
  Duration elapsed() const { return scheduler_.elapsed(); }
  std::unique_ptr<Participant> join(const std::string& name) { return network_.join(77, name); }
  std::shared_ptr<Executor> strand(const std::string& name) {
    machines_.push_back(scheduler_.machine(name, 0ms));
    return machines_.back()->strand(name);
  }
  /// Lets time pass until the condition holds; false when it does not within `limit`.
  bool until(const std::function<bool()>& condition, Duration limit = 10s) {
    const Duration end = scheduler_.elapsed() + limit;
    while (!condition()) {
      if (scheduler_.elapsed() >= end) return false;
      scheduler_.run_until(scheduler_.elapsed() + 1ms);
    }
    return true;
  }
  void pass(Duration time) { scheduler_.run_until(scheduler_.elapsed() + time); }

 private:
  VirtualScheduler scheduler_{1};
  SimulatedNetwork network_;
  std::vector<std::unique_ptr<Runtime>> machines_{};
};

class LiveNet {
 public:
  explicit LiveNet(std::optional<LinkProfile> link = std::nullopt) : link_(std::move(link)) {}
  Duration elapsed() const { return std::chrono::steady_clock::now() - start_; }
  std::unique_ptr<Participant> join(const std::string& name) {
    return std::move(
               open_fastdds({.domain = live::domain(), .name = name, .link = link_, .link_seed = ++seed_}))
        .value();
  }
  std::shared_ptr<Executor> strand(const std::string& name) { return runtime_.strand(name); }
  /// `limit` is stretched by live::patience().
  bool until(const std::function<bool()>& condition, Duration limit = 10s) {
    return live::eventually(condition, live::Seconds(seconds(limit)));
  }
  void pass(Duration time) { live::pass(live::Seconds(seconds(time))); }

 private:
  std::optional<LinkProfile> link_;
  std::uint64_t seed_{};
  std::chrono::steady_clock::time_point start_{std::chrono::steady_clock::now()};
  LiveRuntime runtime_{};
};

/// What handlers saw, readable from the test's thread.
template <class T>
class Seen {
 public:
  void add(T value) {
    const std::lock_guard lock(mutex_);
    values_.push_back(std::move(value));
  }
  std::vector<T> all() const {
    const std::lock_guard lock(mutex_);
    return values_;
  }
  std::size_t size() const {
    const std::lock_guard lock(mutex_);
    return values_.size();
  }

 private:
  mutable std::mutex mutex_{};
  std::vector<T> values_{};
};

/// True where a test may compare times: on virtual time they depend on nothing else.
template <class Net>
inline constexpr bool kVirtualTime = std::is_same_v<Net, MemoryNet>;

/// For typed tests that both wires must pass.
struct NetNames {
  template <class Net>
  static std::string GetName(int) {
    return std::is_same_v<Net, MemoryNet> ? "Memory" : "FastDds";
  }
};
using Nets = testing::Types<MemoryNet, LiveNet>;

}  // namespace adit::wire
