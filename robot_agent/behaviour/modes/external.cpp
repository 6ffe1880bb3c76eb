// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/behaviour/modes/external.hpp"

#include <cmath>

namespace adit::agent {

void ExternalMode::program(const Twist2& velocity, Time now) {
  if (!std::isfinite(velocity.vx) || !std::isfinite(velocity.vy) || !std::isfinite(velocity.wz)) return;
  last_ = now;
  output_.write(Velocity{velocity, true}, now);
}

}  // namespace adit::agent
