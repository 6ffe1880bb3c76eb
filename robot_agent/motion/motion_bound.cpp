// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/motion/motion_bound.hpp"

#include <algorithm>
#include <cmath>

namespace adit::agent {
namespace {

constexpr Duration kLongestTransport = 1s;  // From a sample's stamp to its reception.
constexpr double kTurnsFaster = 1.5;        // As kFaster, for turns: tracks and legs overshoot more.
constexpr double kHeightNoise = 0.15;       // Height noise, m.

/// Returns the longest time between the two measurements that is consistent with receptions and stamps.
Duration time_between(const OdometrySample& from, const OdometrySample& to) {
  const Duration received = std::max(to.received - from.received, Duration{0});
  if (from.stamp == 0 || to.stamp <= from.stamp) return received;
  const std::uint64_t max_stamp = static_cast<std::uint64_t>((received + kLongestTransport).count());
  const std::uint64_t stamped = to.stamp - from.stamp;
  return stamped > max_stamp ? received : std::max(received, Duration(static_cast<std::int64_t>(stamped)));
}

}  // namespace

bool MotionBound::reachable(const OdometrySample& from, const OdometrySample& to, Duration unwatched) const {
  const Platform& p = platform_;
  const double braking = p.max_speed / (2 * p.max_acceleration);
  const double time = std::min(seconds(time_between(from, to)), seconds(unwatched) + braking);
  const Eigen::Vector3d moved = to.T_odom_base.position - from.T_odom_base.position;
  if (moved.head<2>().norm() > kFaster * p.max_speed * time + kNoise) return false;
  // A body on the ground climbs a step between two samples.
  const double climb = p.flies() ? p.max_climb : p.max_speed * p.steepest();
  const double step = p.flies() ? 0.0 : p.step;
  if (std::fabs(moved.z()) > kFaster * climb * time + step + kHeightNoise) return false;
  const double turned = std::fabs(wrap_angle(to.T_odom_base.yaw() - from.T_odom_base.yaw()));
  return turned <= kTurnsFaster * p.max_turn * time + kHeadingNoise;
}

}  // namespace adit::agent
