// SPDX-License-Identifier: Apache-2.0
#include "bench/perception/stated_poses.hpp"

#include <algorithm>
#include <cmath>

namespace adit::bench {
namespace {

/// A state holds the newest odometry of the driver, which is up to 50 ms old (20 Hz) when it is used, and
/// comes up to 40 ms later when it was overtaken (docs/rehearsal.md): the error is the least since then.
constexpr Duration kAge = 100ms;

}  // namespace

void Stretch::add(Duration now, bool holds) {
  if (!holds) {
    since_.reset();
    return;
  }
  if (!since_) since_ = now;
  if (now - *since_ <= longest) return;
  longest = now - *since_;
  ended = now;
}

void StatedPoses::truth(Duration now, const Pose2& pose) {
  if (!past_.empty()) way_ += (pose.position() - past_.back().pose.position()).norm();
  past_.push_back({now, pose});
  while (now - past_.front().at > kAge) past_.pop_front();
}

void StatedPoses::stated(Duration now, const sim::StateSent& state) {
  if (past_.empty() || state.localisation == Localisation::off) return;
  ++states_;
  const bool claims = state.localisation == Localisation::ok || state.localisation == Localisation::weak;
  if (!claims && !reference_) return;
  if (!reference_) reference_ = past_.back().pose * state.pose.planar().inverse();
  const Eigen::Vector2d stated = (*reference_ * state.pose.planar()).position();
  double error = (stated - past_.front().pose.position()).norm();
  for (const Past& past : past_) error = std::min(error, (stated - past.pose.position()).norm());
  const bool beyond = error > 5.0 * state.sigma + 0.1;
  beyond_.add(now, claims && beyond);
  silent_.add(now, !claims && beyond);
  lost_.add(now, state.localisation == Localisation::ok && error > std::max(1.0, 5.0 * state.sigma));
  if (!claims) return;
  ++claimed_;
  at_once_ += (stated - past_.back().pose.position()).norm() <= 3.0 * state.sigma;
  within_ += error <= 3.0 * state.sigma;
  ratios_.push_back(error / std::max(1e-3, state.sigma));
  squared_ += error * error;
  largest_ = std::max(largest_, error);
  end_ = error;
}

double StatedPoses::ate() const {
  return claimed_ == 0 ? 0.0 : std::sqrt(squared_ / static_cast<double>(claimed_));
}
double StatedPoses::within() const {
  return claimed_ == 0 ? 1.0 : static_cast<double>(within_) / static_cast<double>(claimed_);
}
double StatedPoses::unclaimed() const {
  return states_ == 0 ? 1.0 : 1.0 - static_cast<double>(claimed_) / static_cast<double>(states_);
}

}  // namespace adit::bench
