#include "robot_agent/motion/external.hpp"

#include <cmath>

namespace adit::agent {

void External::heard(const Twist2& velocity, Time now) {
  if (!std::isfinite(velocity.vx) || !std::isfinite(velocity.vy) || !std::isfinite(velocity.wz)) return;
  last_ = now;
  output_.write(Velocity{velocity, true}, now);
}

}  // namespace adit::agent
