// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>
#include <optional>

#include "core/result/reason.hpp"
#include "core/time/time.hpp"

namespace adit::agent {

/// Repeats the return to the start that a nearly empty battery asks for, until it is accepted. A refused
/// attempt is repeated after `first_pause`, and each pause is twice as long as the one before, up to 30 s.
/// The return ends without success when the battery recovers, when the robot is no longer in an autonomous
/// mode (a robot that holds is not made to move), or when the holder requested something since. A pure state
/// machine.
class BatteryReturn {
 public:
  static constexpr Duration kLongestPause = 30s;

  explicit BatteryReturn(Duration first_pause = 1s) : first_pause_(first_pause) {}

  struct Inputs {
    bool autonomous{};         ///< The mode follows goals by itself.
    bool nearly_empty{};       ///< The charge is below the last threshold.
    std::uint64_t requests{};  ///< Number of the holder's requests accepted so far.
  };

  /// Starts the attempts. `requests`: as in Inputs, at this time.
  void begin(std::uint64_t requests, Time now) {
    requests_ = requests;
    next_ = now;
    pause_ = first_pause_;
    refused_because_ = Reason::none;
  }
  /// Whether the return must be attempted now; the caller then calls accepted() or refused().
  bool due(const Inputs& in, Time now) {
    if (!in.autonomous || !in.nearly_empty || in.requests != requests_) next_.reset();
    return next_ && now >= *next_;
  }
  void accepted() { next_.reset(); }
  /// Returns whether operators do not know of this refusal yet: it is the first one, or has another reason.
  [[nodiscard]] bool refused(Reason reason, Time now) {
    next_ = now + pause_;
    pause_ = std::min(2 * pause_, kLongestPause);
    const bool unknown = reason != refused_because_;
    refused_because_ = reason;
    return unknown;
  }
  /// Whether the return must be attempted again after a restart. `requests`: as in Inputs.
  bool pending(std::uint64_t requests) const { return next_ && requests == requests_; }

 private:
  std::uint64_t requests_{};
  std::optional<Time> next_{};  ///< Time of the next attempt; unset: no return is pending.
  Duration first_pause_, pause_{first_pause_};
  Reason refused_because_{Reason::none};
};

}  // namespace adit::agent
