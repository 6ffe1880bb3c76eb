// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/time/time.hpp"
#include "core/wire/participant.hpp"
#include "robot_agent/common/rate_limit.hpp"

namespace adit::agent {

/// Detects a second writer of /cmd_vel, with which none of the agent's safety rules can be guaranteed.
class RivalWatch {
 public:
  /// The agent's parent process sends zeros while the agent is not running, and slightly longer.
  static constexpr Duration kGrace{3s};
  /// One sample may be a manual test; this many within kWindow count as a writer.
  static constexpr int kSamples{3};
  static constexpr Duration kWindow{1s};
  /// Period of repeated reports of the same writer.
  static constexpr Duration kAgain{30s};

  explicit RivalWatch(Time started) : started_(started) {}

  /// Processes a velocity of another participant. Returns true if operators must be notified now.
  bool heard(const wire::ParticipantId& writer, Time now) {
    if (now - started_ < kGrace) return false;
    if (writer != writer_ || now - since_ > kWindow) {
      writer_ = writer;
      since_ = now;
      count_ = 0;
    }
    return ++count_ >= kSamples && reported_.pass(writer, now);
  }

 private:
  Time started_;
  wire::ParticipantId writer_{};
  int count_{};
  Time since_{};
  RateLimit<wire::ParticipantId> reported_{kAgain, 8};
};

}  // namespace adit::agent
