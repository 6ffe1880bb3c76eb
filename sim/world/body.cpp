// SPDX-License-Identifier: Apache-2.0
#include "sim/world/body.hpp"

#include <algorithm>
#include <cmath>

namespace adit::sim {
namespace {

constexpr double kNoWay = 1e-3;  // m/s: a slower command says nothing about a car's wheels

}  // namespace

Pose2 arc(const Twist2& v, double dt) {
  // Its chord: exact for a constant velocity up to second order.
  const double half = 0.5 * v.wz * dt, c = std::cos(half), s = std::sin(half);
  return {(v.vx * c - v.vy * s) * dt, (v.vx * s + v.vy * c) * dt, v.wz * dt};
}

void Body::command(const Twist2& wanted) {
  const auto finite = [](double v) { return std::isfinite(v) ? v : 0.0; };
  wanted_ = platform_.limited({finite(wanted.vx), finite(wanted.vy), finite(wanted.wz), finite(wanted.vz)});
  // Of a car that shall stand the wheels stay as they are.
  if (platform_.drive == Drive::car && std::abs(wanted_.vx) > kNoWay)
    wheels_wanted_ = std::clamp(std::atan(platform_.wheelbase * wanted_.wz / wanted_.vx),
                                -platform_.max_steering, platform_.max_steering);
  silence_ = 0.0;
}

Pose2 Body::advance(double dt) {
  silence_ += dt;
  if (silence_ > watchdog_) wanted_ = {};
  const double dvx = wanted_.vx - twist_.vx, dvy = wanted_.vy - twist_.vy;
  const double change = std::hypot(dvx, dvy), limit = platform_.max_acceleration * dt;
  const double part = change > limit ? limit / change : 1.0;
  const double turn_limit = platform_.max_turn_acceleration * dt;
  // The last piece is taken as it is: rounding leaves no creeping remainder.
  twist_.vx = part < 1.0 ? twist_.vx + part * dvx : wanted_.vx;
  twist_.vy = part < 1.0 ? twist_.vy + part * dvy : wanted_.vy;
  twist_.wz += std::clamp(wanted_.wz - twist_.wz, -turn_limit, turn_limit);
  if (platform_.drive == Drive::car) {
    const double steer_limit = platform_.steering_rate * dt;
    wheels_ += std::clamp(wheels_wanted_ - wheels_, -steer_limit, steer_limit);
    twist_.wz = twist_.vx * std::tan(wheels_) / platform_.wheelbase;
  }
  return pose_ * arc(twist(), dt);
}

double Body::climb(double z, double ground, double ceiling, double dt) {
  constexpr double kLowest = 0.3, kUnder = 0.2;  // m: above the ground, below the ceiling
  above_ += wanted_.vz * dt;
  const double highest = ceiling - platform_.height - kUnder - ground;
  above_ = std::max(std::min(above_, highest), std::min(kLowest, platform_.hover_height));
  return z + std::clamp(ground + above_ - z, -platform_.max_climb * dt, platform_.max_climb * dt);
}

Twist2 Body::twist(double turn_share) const {
  // What a car turns about is its rear axle.
  const double turn = turn_share * twist_.wz;
  return {twist_.vx, twist_.vy + platform_.rear_axle() * turn, (1.0 - platform_.turn_slip) * turn};
}

}  // namespace adit::sim
