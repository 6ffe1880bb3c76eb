#pragma once
#include <array>

#include "core/time/time.hpp"
#include "robot_agent/command/types.hpp"

namespace adit::agent {

/// Judges the joystick stream of the holder: rising numbers, and freshness by our own clock. A sample echoes
/// a stamp that we sent; foreign clocks are never read.
class StickGate {
 public:
  static constexpr Duration kMaxAge = 600ms;   ///< of the echoed stamp
  static constexpr Duration kMaxWait = 300ms;  ///< from reception until the sample is handled

  /// We sent a robot state with this stamp.
  void sent(std::uint64_t stamp) {
    stamps_[next_] = stamp;
    next_ = (next_ + 1) % stamps_.size();
  }
  /// none, stale_sequence, sample_stale, out_of_range. An accepted sample's number is remembered.
  Reason judge(const StickSample& sample, Time now);

 private:
  std::array<std::uint64_t, 32> stamps_{};  // 3.2 s at 10 Hz
  std::size_t next_{};
  wire::ParticipantId stream_{};  // the numbers belong to this participant's stream
  std::uint64_t newest_{};
};

}  // namespace adit::agent
