// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/discovery/binding.hpp"

namespace adit::agent {

Binding::Verdict Binding::hear(const wire::ParticipantId& from, bool announces, Time now) {
  if (from == participant_) {
    Verdict verdict{.bound = true};
    if (claimant_ && now - claimed_ >= kGrace) verdict.found_out = rival_ = claimant_;
    if (verdict.found_out) claimant_.reset();
    speak(now);
    return verdict;
  }
  const bool silent = !alive(now, kSilent);
  if (!silent && rival_ == from) return {};
  if (!silent && former_ == from) {
    if (now - moved_ < kGrace) return {};
    rival_ = participant_;
    former_.reset();
    claimant_.reset();
    participant_ = from;
    speak(now);
    return {.bound = true, .found_out = rival_};
  }
  const bool first = claimant_ != from;
  if (!silent && first && !announces) return {};
  if (silent || !alive(now, kQuiet)) {
    move(from, now);
    return {.bound = true, .restarted = first};
  }
  if (!claimant_) claimed_ = now;
  claimant_ = from;
  return {.pending = true, .restarted = first};
}

void Binding::speak(Time now) {
  heard_ = now;
  left_ = false;
}

void Binding::move(const wire::ParticipantId& to, Time now) {
  former_ = participant_;
  moved_ = now;
  participant_ = to;
  claimant_.reset();
  speak(now);
}

}  // namespace adit::agent
