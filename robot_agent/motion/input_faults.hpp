// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <tuple>

#include "robot_agent/common/notice.hpp"
#include "robot_agent/motion/one_source.hpp"

namespace adit::agent {

/// Something that arrives from the robot's driver and cannot be used, or only in part.
struct InputFault {
  std::string topic{};  ///< Without a slash in front, as in a platform's file.
  const char* code{};   ///< Of the notification.
  Severity severity{Severity::warning};
  Error cause{};  ///< Its text names the value, what is expected, and what to change.
};

/// Two participants write the topic.
InputFault two_sources(const std::string& topic, const OneSource& source);

/// The faults of what arrives on the robot domain: each is reported to all operators once, and again when it
/// returns, and stands in the health report's row "inputs" while it lasts. Bounded. Callable from any thread.
class InputFaults {
 public:
  /// A fault that was not reported for so long is over.
  static constexpr Duration kQuiet{10s};

  /// Called without a lock, by the thread that reports. `tell` also writes to the log.
  struct Outputs {
    std::function<void(const Notice&)> tell{};
    std::function<void(const contract::ComponentHealth&)> note{};
  };

  InputFaults(std::string robot, Outputs outputs) : robot_(std::move(robot)), outputs_(std::move(outputs)) {}

  /// Call it for each message with the fault.
  void report(const InputFault& fault, Time now);
  /// Ends faults that were not reported any more. About once a second.
  void tick(Time now);

 private:
  static constexpr std::size_t kMost = 32;
  using Key = std::tuple<std::string, std::string, Reason>;  // Topic, code, reason.
  struct Entry {
    Severity severity{};
    std::string text{};
    Time seen{};
  };
  contract::ComponentHealth row() const;

  const std::string robot_;
  const Outputs outputs_;
  std::mutex mutex_{};
  std::map<Key, Entry> entries_{};
};

}  // namespace adit::agent
