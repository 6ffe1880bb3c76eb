// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/exec/executor.hpp"
#include "core/wire/link.hpp"
#include "core/wire/participant.hpp"

namespace adit::live {

/// A few machines with their radio and inner networks, in rehearsal or live in this process over Fast DDS,
/// so that the same test body runs on both.
class Net {
 public:
  virtual ~Net() = default;
  /// Lives as long as the net.
  virtual Runtime& machine(const std::string& name) = 0;
  virtual std::unique_ptr<wire::Participant> join_radio(const std::string& machine) = 0;
  /// The inner network of one robot.
  virtual std::unique_ptr<wire::Participant> join_robot(const std::string& machine) = 0;
  /// The machine's radio participants fall silent without a goodbye; live they do so when they are unused.
  virtual void silence(const std::string& machine) = 0;
  /// Runs the work on that strand and waits for its end.
  virtual void on(Executor& strand, const std::function<void()>& work) = 0;
  /// Lets time pass until the condition holds; false when it does not within `limit`, which live is stretched
  /// by patience().
  virtual bool until(const std::function<bool()>& condition, Duration limit = std::chrono::seconds(10)) = 0;
  /// One clock for all machines, which they do not have.
  virtual Duration clock() const = 0;
  virtual void pass(Duration time) = 0;
};

/// `link`: between all machines, on the radio; `inner`: one way on the robots' inner networks.
std::unique_ptr<Net> make_rehearsal_net(const wire::LinkProfile& link = {.latency = 0.0001},
                                        Duration inner = std::chrono::microseconds(100));
/// `link`: what each machine sends by radio keeps to it; none: the sockets alone.
std::unique_ptr<Net> make_live_net(std::optional<wire::LinkProfile> link = std::nullopt);

/// A value that strands write and the test reads.
template <class T>
class Shared {
 public:
  template <class F>
  auto use(F&& function) {
    const std::lock_guard lock(mutex_);
    return function(value_);
  }
  T get() const {
    const std::lock_guard lock(mutex_);
    return value_;
  }

 private:
  mutable std::mutex mutex_{};
  T value_{};
};

}  // namespace adit::live
