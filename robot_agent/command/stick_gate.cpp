// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/command/stick_gate.hpp"

#include <algorithm>
#include <cmath>

namespace adit::agent {

Reason StickGate::judge(const StickSample& sample, Time now) {
  const Twist2& t = sample.twist;
  if (!std::isfinite(t.vx) || !std::isfinite(t.vy) || !std::isfinite(t.wz)) return Reason::out_of_range;
  if (sample.participant != stream_) {
    stream_ = sample.participant;
    newest_ = 0;
  }
  if (sample.seq <= newest_) return Reason::stale_sequence;
  const bool ours =
      sample.echo != 0 && std::find(stamps_.begin(), stamps_.end(), sample.echo) != stamps_.end();
  if (!ours || now - from_stamp(sample.echo) > kMaxAge || sample.waited > kMaxWait)
    return Reason::sample_stale;
  newest_ = sample.seq;
  return Reason::none;
}

}  // namespace adit::agent
