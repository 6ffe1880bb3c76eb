#pragma once
#include <optional>

#include "core/time/time.hpp"
#include "core/wire/participant.hpp"
#include "robot_agent/common/rate_limit.hpp"

namespace adit::agent {

/// Notices a second writer of /cmd_vel: wheels with two masters obey neither, and no rule of ours holds.
class RivalWatch {
 public:
  /// The agent's parent sends zeros while the agent is away, and a little longer.
  static constexpr Duration kGrace{3s};
  /// One sample may be a probe by hand; this many within kWindow are a master.
  static constexpr int kSamples{3};
  static constexpr Duration kWindow{1s};
  /// The same one is told again after this.
  static constexpr Duration kAgain{30s};

  explicit RivalWatch(Time started) : started_(started) {}

  /// Somebody else's velocity. True: tell of him now.
  bool heard(const wire::ParticipantId& writer, Time now);

 private:
  Time started_;
  wire::ParticipantId writer_{};
  int count_{};
  Time since_{};
  RateLimit<wire::ParticipantId> told_{kAgain, 8};
};

}  // namespace adit::agent
