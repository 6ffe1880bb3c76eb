// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/discovery/binding.hpp"

namespace adit::agent {

Binding::Verdict Binding::on_heartbeat(const wire::ParticipantId& from, MayClaim may_claim, Time now) {
  if (from == participant_) return on_bound_heartbeat(now);
  const bool silent = !alive(now, kBindingTimeout);
  if (!silent && rejected_ == from) return {};
  if (!silent && previous_ == from) {
    if (now - rebound_at_ < kGrace) return {};
    // The previous participant still sends, so the present one is no restart of it.
    rejected_ = participant_;
    previous_.reset();
    claimant_.reset();
    participant_ = from;
    mark_seen(now);
    return {.bound = true, .rejected = rejected_};
  }
  const bool first_claim = claimant_ != from;
  if (!silent && first_claim && may_claim == MayClaim::no) return {};
  if (silent || !alive(now, kHeartbeatTimeout)) {
    rebind(from, now);
    return {.bound = true, .restarted = first_claim};
  }
  if (!claimant_) claimed_at_ = now;
  claimant_ = from;
  return {.pending = true, .restarted = first_claim};
}

Binding::Verdict Binding::on_bound_heartbeat(Time now) {
  Verdict verdict{.bound = true};
  // The bound participant sends after the claim: the claimant is no restart of it.
  if (claimant_ && now - claimed_at_ >= kGrace) verdict.rejected = rejected_ = claimant_;
  if (verdict.rejected) claimant_.reset();
  mark_seen(now);
  return verdict;
}

void Binding::mark_seen(Time now) {
  last_seen_ = now;
  left_ = false;
}

void Binding::rebind(const wire::ParticipantId& to, Time now) {
  previous_ = participant_;
  rebound_at_ = now;
  participant_ = to;
  claimant_.reset();
  mark_seen(now);
}

}  // namespace adit::agent
