// SPDX-License-Identifier: Apache-2.0
#include "nav/control/controller.hpp"

#include <algorithm>
#include <cmath>

#include "nav/control/ilqr_controller.hpp"
#include "nav/control/pure_pursuit.hpp"

namespace adit::nav {
namespace {

// Above this heading error at its path's start a robot turns on the spot, rad.
constexpr double kTurnFrom = 0.45;
constexpr double kTurnUntil = 0.12;  ///< It ends that turn below this heading error, rad.
// Time constant of the estimate of the turn effectiveness of tracks, s.
constexpr double kGripMemory = 3.0;
constexpr double kStanding = 0.12;  ///< Below this speed a turn on the spot may begin, m/s.
/// Below this speed a velocity does not define a car's steering angle, m/s.
constexpr double kNoDirection = 1e-3;
constexpr double kFarOff = 0.15;     ///< Above this error of its steering angle a car drives at kSteers, rad.
constexpr double kSteers = 0.15;     ///< Speed of a car while its steering angle is wrong, m/s.
constexpr double kSteerShare = 0.9;  ///< Fraction of the steering rate that is counted on.

double stepped(double from, double to, double step) { return from + std::clamp(to - from, -step, step); }

}  // namespace

Controller::Controller(const Platform& platform) : platform_(platform), grip_(1.0 - platform.turn_slip) {}

Twist2 Controller::stop_now() {
  plan_ = {};
  turning_ = false;
  rest();
  sent_turn_ = 0;
  yaw_before_.reset();
  return last_ = {};
}

void Controller::set_plan(const Plan& plan) {
  plan_ = plan;
  if (platform_.turns_on_spot()) return;
  const Pose2 axle{-platform_.rear_axle(), 0, 0};
  for (std::size_t i = 0; i < plan_.pose_count; ++i) plan_.poses[i] = plan_.poses[i] * axle;
}

Twist2 Controller::follow(const Pose2& odom, double dt) {
  if (!platform_.turns_on_spot())
    return last_ = steered(desired(odom * Pose2{-platform_.rear_axle(), 0, 0}, dt), dt);
  if (platform_.drive == Drive::tracked) learn_grip(odom, dt);
  last_ = towards(desired(odom, dt), dt);
  return against_slip(last_);
}

void Controller::sent(const Twist2& velocity) {
  last_ = velocity;
  // A velocity of zero says nothing about the steering of a car.
  steering_ = std::fabs(velocity.vx) < kNoDirection
                  ? steering_before_
                  : std::clamp(std::atan(platform_.wheelbase * velocity.wz / velocity.vx),
                               -platform_.max_steering, platform_.max_steering);
  sent_turn_ = velocity.wz;
  last_.wz *= grip_;
}

void Controller::learn_grip(const Pose2& odom, double dt) {
  constexpr double kEnough = 0.05;  // rad2/s: a smaller sum is too noisy.
  if (yaw_before_) {
    const double keep = std::exp(-dt / kGripMemory);
    asked_ = keep * asked_ + sent_turn_ * sent_turn_ * dt;
    come_ = keep * come_ + sent_turn_ * wrap_angle(odom.yaw - *yaw_before_);
    if (asked_ > kEnough) grip_ = std::clamp(come_ / asked_, 0.2, 1.0);
  }
  yaw_before_ = odom.yaw;
}

Twist2 Controller::against_slip(const Twist2& body) {
  sent_turn_ = std::clamp(body.wz / grip_, -platform_.max_turn, platform_.max_turn);
  return {body.vx, body.vy, sent_turn_, body.vz};
}

Twist2 Controller::desired(const Pose2& odom, double dt) {
  const auto path = plan_.path();
  if (path.size() < 2) {
    turning_ = false;
    rest();
    return {};
  }
  Place place{};
  const auto off_path = [&odom](const Pose2& p) { return (p.position() - odom.position()).squaredNorm(); };
  place.nearest = static_cast<std::size_t>(std::ranges::min_element(path, {}, off_path) - path.begin());
  const double spacing = plan_.length / static_cast<double>(path.size() - 1);
  place.remaining = spacing * static_cast<double>(path.size() - 1 - place.nearest);

  double error = wrap_angle(path[place.nearest].yaw - odom.yaw);
  const double off = std::fabs(error);
  const bool turns = turning_ || plan_.turn_first;
  turning_ = platform_.turns_on_spot() && off > (turns ? kTurnUntil : kTurnFrom);
  if (turning_) {
    rest();
    // The planner may have found that only the longer turn is free.
    if (plan_.turn != 0 && error * plan_.turn < 0 && off > M_PI / 3) error += plan_.turn * 2 * M_PI;
    return turn_on_spot(error);
  }
  return track(odom, place, dt);
}

Twist2 Controller::turn_on_spot(double error) const {
  if (std::hypot(last_.vx, last_.vy) > kStanding) return {};
  const double rate = std::sqrt(2 * kBrakingShare * platform_.max_turn_acceleration * std::fabs(error));
  return {0, 0, std::copysign(std::min(platform_.max_turn, rate), error)};
}

Twist2 Controller::towards(const Twist2& wanted, double dt) const {
  const Eigen::Vector2d from(last_.vx, last_.vy);
  Eigen::Vector2d change = Eigen::Vector2d(wanted.vx, wanted.vy) - from;
  const double most = platform_.max_acceleration * dt;
  if (change.norm() > most) change *= most / change.norm();
  const Eigen::Vector2d v = from + change;
  return {v.x(), v.y(), stepped(last_.wz, wanted.wz, platform_.max_turn_acceleration * dt)};
}

Twist2 Controller::steered(const Twist2& wanted, double dt) {
  const Platform& p = platform_;
  const double most = p.max_steering;
  const double target = std::fabs(wanted.vx) < kNoDirection
                            ? steering_
                            : std::clamp(std::atan(p.wheelbase * wanted.wz / wanted.vx), -most, most);
  steering_before_ = steering_;
  steering_ = stepped(steering_, target, kSteerShare * p.steering_rate * dt);
  double speed = wanted.vx;
  if (std::fabs(target - steering_) > kFarOff) speed = std::clamp(speed, -kSteers, kSteers);
  const double bend = std::tan(steering_) / p.wheelbase;
  if (std::fabs(bend * speed) > p.max_turn) speed = std::copysign(p.max_turn / std::fabs(bend), speed);
  speed = stepped(last_.vx, speed, p.max_acceleration * dt);
  return {speed, 0, speed * bend};
}

const std::vector<std::string>& controller_names() {
  static const std::vector<std::string> names{"ilqr", "pure_pursuit"};
  return names;
}

Result<std::unique_ptr<Controller>> make_controller(const std::string& name, const Platform& platform) {
  if (name == "ilqr") return std::unique_ptr<Controller>(make_ilqr_controller(platform));
  if (name == "pure_pursuit") return std::unique_ptr<Controller>(std::make_unique<PurePursuit>(platform));
  return {Reason::bad_argument, "no controller '" + name + "': ilqr or pure_pursuit"};
}

}  // namespace adit::nav
