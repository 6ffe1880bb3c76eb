// SPDX-License-Identifier: Apache-2.0
#include "sim/world/person.hpp"

#include <cmath>

namespace adit::sim {

Person::Person(PersonSpec spec) : spec_(std::move(spec)) {
  for (std::size_t n = 1; n < spec_.path.size(); ++n) length_ += (spec_.path[n] - spec_.path[n - 1]).norm();
}

Rectangle Person::at(double way) const {
  double left = way <= length_ ? way : 2.0 * length_ - way;
  Eigen::Vector2d place = spec_.path.back();
  for (std::size_t n = 1; n < spec_.path.size(); ++n) {
    const Eigen::Vector2d leg = spec_.path[n] - spec_.path[n - 1];
    const double part = leg.norm();
    if (left <= part) {
      place = part > 0.0 ? Eigen::Vector2d(spec_.path[n - 1] + leg * (left / part)) : spec_.path[n];
      break;
    }
    left -= part;
  }
  return {{place.x(), place.y(), 0.0}, kSize, kSize};
}

Rectangle Person::next(double dt) const {
  return length_ > 0.0 ? at(std::fmod(way_ + spec_.speed * dt, 2.0 * length_)) : body();
}

void Person::lean(double dt) {
  wait();
  leant_ += dt;
  if (leant_ < kPatience) return;
  leant_ = 0.0;
  before_ = way_ = 2.0 * length_ - way_;
}

void Person::take(double dt) {
  before_ = way_;
  if (length_ > 0.0) way_ = std::fmod(way_ + spec_.speed * dt, 2.0 * length_);
}

}  // namespace adit::sim
