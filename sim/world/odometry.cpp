// SPDX-License-Identifier: Apache-2.0
#include "sim/world/odometry.hpp"

#include <cmath>

namespace adit::sim {

Odometry::Odometry(const OdometryParams& params, std::uint64_t seed)
    : params_(params),
      random_(seed),
      scale_(1.0 + params.scale * gaussian(random_)),
      rate_(params.drift * M_PI / 180.0 * gaussian(random_)) {
  if (params.turn > 0.0) turn_ += params.turn * gaussian(random_);  // else no draw: old runs stay as they are
}

void Odometry::move(const Pose2& from, const Pose2& to, double dt) {
  Pose2 motion = from.inverse() * to;
  const double way = std::hypot(motion.x, motion.y);
  motion.yaw *= turn_;
  if (way > 1e-9) {  // less is rounding
    const double keep = std::exp(-way / params_.correlation);
    const double deviation = params_.drift * M_PI / 180.0;
    rate_ = keep * rate_ + std::sqrt(1.0 - keep * keep) * deviation * gaussian(random_);
    motion.x *= scale_;
    motion.y *= scale_;
    motion.yaw += rate_ * way;
  }
  pose_ = pose_ * motion;
  twist_ = {motion.x / dt, motion.y / dt, motion.yaw / dt};
}

}  // namespace adit::sim
