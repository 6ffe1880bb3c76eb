// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/safeguard/link_loss.hpp"

namespace adit::agent {

LinkLoss::Step LinkLoss::tick(const Inputs& in, Time now) {
  Step step{};
  step.silence = now - in.heard;
  const bool lost = in.held && step.silence >= params_.after;
  if (!lost) {
    step.found = lost_;
    lost_ = acted_ = false;
    way_ = Way::none;
    retry_.reset();
    // Heartbeats arrive once a second: a position with a recent heartbeat counts as linked.
    if (in.held && in.place && step.silence < 1500ms) linked_ = in.place;
    return step;
  }
  step.lost = !lost_;
  lost_ = true;
  if (!in.autonomous || params_.action == OnLoss::go_on) return step;
  if (retry_ && now < *retry_) return step;
  const bool again = retry_.has_value();
  retry_.reset();
  if (params_.action == OnLoss::hold) {
    step.hold = !acted_;
    acted_ = true;
    return step;
  }
  if (way_ == Way::none) {
    way_ = linked_ ? Way::to_link : Way::to_start;
    since_ = now;
  } else if (way_ == Way::to_link && in.arrived) {
    if (now - since_ < params_.after) return step;
    way_ = Way::to_start;
  } else if (!again) {
    if (!in.arrived) since_ = now;  // The wait begins on arrival.
    return step;
  }
  step.go_to = way_ == Way::to_link ? *linked_ : params_.start;
  return step;
}

}  // namespace adit::agent
