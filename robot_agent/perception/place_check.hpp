// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "core/result/reason.hpp"
#include "core/time/time.hpp"

namespace adit::agent {

/// The recognition of the surroundings after a restart of the agent (rule 7).
///
/// Until a scan was compared with the stored keyframes, and after one that does not fit them, autonomous
/// modes do not run. A robot that does not recognise its surroundings waits for `pose R X Y YAW`.
class PlaceCheck {
 public:
  /// How long it waits for a scan that shows enough. A lidar needs seconds to spin up, and a hand in front of
  /// it is gone by then.
  static constexpr Duration kPatience = 10s;

  /// The agent was started again: a scan must be compared.
  void begin() {
    state_ = State::waiting;
    shows_too_little_since_.reset();
  }
  /// The last comparison had no result: another scan must be compared.
  void again() { state_ = State::waiting; }
  /// The last scan showed too little to compare it: another one must be. Returns false when that has been so
  /// for kPatience.
  bool wait_for_better(Time now) {
    again();
    if (!shows_too_little_since_) shows_too_little_since_ = now;
    return now - *shows_too_little_since_ < kPatience;
  }
  /// A comparison begins.
  void compare() { state_ = State::comparing; }
  /// The surroundings are known, or there is nothing to compare with, or an operator set the pose.
  void confirm() { state_ = State::known; }
  void refuse() { state_ = State::unknown; }

  bool known() const { return state_ == State::known; }
  bool waits() const { return state_ == State::waiting; }
  /// Whether a comparison is pending or has begun.
  bool pending() const { return waits() || state_ == State::comparing; }
  bool refused() const { return state_ == State::unknown; }
  /// Why autonomous modes do not run; none: they do.
  Reason why() const {
    return known() ? Reason::none : refused() ? Reason::not_localised_here : Reason::just_restarted;
  }

 private:
  enum class State { known, waiting, comparing, unknown };
  State state_{State::known};
  std::optional<Time> shows_too_little_since_{};
};

}  // namespace adit::agent
