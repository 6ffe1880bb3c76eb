// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>

#include "core/time/time.hpp"
#include "robot_agent/command/types.hpp"

namespace adit::agent {

/// Judges the joystick stream of the holder: numbers must rise, and samples must be fresh by the robot's own
/// clock. A sample echoes a stamp that this robot sent; the station's clock is not used.
class StickGate {
 public:
  static constexpr Duration kMaxAge = 600ms;   ///< Of the echoed stamp.
  static constexpr Duration kMaxWait = 300ms;  ///< From reception until the sample is handled.

  /// Records the stamp of a robot state that was sent.
  void sent(std::uint64_t stamp) {
    stamps_[next_] = stamp;
    next_ = (next_ + 1) % stamps_.size();
  }
  /// Returns none, stale_sequence, sample_stale or out_of_range. An accepted sample's number is remembered.
  Reason judge(const StickSample& sample, Time now);

 private:
  std::array<std::uint64_t, 32> stamps_{};  // 3.2 s at 10 Hz.
  std::size_t next_{};
  wire::ParticipantId stream_{};  // The participant whose stream has these numbers.
  std::uint64_t newest_{};
};

}  // namespace adit::agent
