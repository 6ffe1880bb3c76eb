// SPDX-License-Identifier: Apache-2.0
#include "perception/odometry/slip_watch.hpp"

#include <algorithm>
#include <cmath>

namespace adit::perception {
namespace {

constexpr double kShown = 0.5;      ///< A contradiction of so long is no delay of a sensor, s.
constexpr double kAgreement = 1.0;  ///< For so long both agree before the slip is over, s.

}  // namespace

void SlipWatch::compare(const Eigen::Vector3d& off, const Eigen::Vector3d& known,
                        const Eigen::Vector3d& variance, double dt) {
  bool apart = false, agree = true;
  for (int axis = 0; axis < 3; ++axis) {
    const double size = std::abs(off[axis]);
    if (size * size > kGate * (known[axis] + variance[axis])) {
      // What does not know the speed well cannot show a larger contradiction.
      if (bound_[axis] == 0 || 9 * known[axis] < bound_[axis] * bound_[axis])
        bound_[axis] = std::max(bound_[axis], size);
      apart = true;
    }
    // What hardly knows the speed itself agrees with everything.
    const double near = std::max(bound_[axis] / 3, std::sqrt(kGate * variance[axis]));
    if (bound_[axis] > 0 && (size > near || known[axis] > near * near)) agree = false;
  }
  if (!apart && agree) return rest(dt);
  agrees_for_ = 0.0;
  apart_for_ += dt;
}

bool SlipWatch::lasts() const { return apart_for_ >= kShown; }

void SlipWatch::rest(double dt) {
  agrees_for_ += dt;
  if (agrees_for_ >= kAgreement) clear();
}

}  // namespace adit::perception
