// SPDX-License-Identifier: Apache-2.0
#include "nav/control/ilqr_controller.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "nav/control/ilqr.hpp"

namespace adit::nav {
namespace {

constexpr double kLookAheadStep = 0.05;  ///< Step of the horizon, s.
constexpr double kShortestPath = 0.05;   ///< The path counts as driven when less than this is left, m.
/// Minimum speed of the references, m/s: a lower one would not reach the end of the path.
constexpr double kCreepSpeed = 0.02;
constexpr double kTurnShare = 0.8;  ///< Fraction of the platform's turn rate that a path's curvature may use.

/// A point that moves along the path of a plan.
class Walk {
 public:
  Walk(const Plan& plan, std::size_t nearest, const Pose2& odom) : plan_(plan), path_(plan.path()) {
    spacing_ = std::max(1e-6, plan.length / static_cast<double>(path_.size() - 1));
    // Starts at the nearest pose, moved along the path by at most one spacing to be level with the robot.
    const Pose2& p = path_[nearest];
    const double side = plan.reverse ? -1.0 : 1.0;
    const double along = side * (std::cos(p.yaw) * (odom.x - p.x) + std::sin(p.yaw) * (odom.y - p.y));
    at_ = spacing_ * static_cast<double>(nearest) + std::clamp(along, -spacing_, spacing_);
    at_ = std::clamp(at_, 0.0, plan.length);
  }

  double remaining() const { return plan_.length - at_; }
  /// A path that does not end in a stop goes straight on beyond its end.
  void advance(double distance) {
    at_ = plan_.end_speed > 0 ? at_ + distance : std::min(plan_.length, at_ + distance);
  }
  Pose2 pose() const {
    if (at_ > plan_.length) return path_.back() * Pose2{at_ - plan_.length, 0, 0};
    const auto [i, part] = spot();
    const Pose2 &a = path_[i], &b = path_[i + 1];
    return {a.x + part * (b.x - a.x), a.y + part * (b.y - a.y),
            wrap_angle(a.yaw + part * wrap_angle(b.yaw - a.yaw))};
  }
  /// Curvature at this point, rad/m.
  double curvature() const { return at_ > plan_.length ? 0.0 : bend(spot().index); }
  /// Interpolates a table over the path's poses at this point.
  double at(const std::array<double, Plan::kMaxPath>& table) const {
    const auto [i, part] = spot();
    return table[i] + part * (table[i + 1] - table[i]);
  }
  /// Computes the speed limit at each pose of the path from the turn rate `max_turn` (rad/s), the speed at
  /// the path's end, and braking for both with `braking` (m/s2). `max_swing`: maximum change of curvature
  /// over time, rad/m/s; 0: unlimited.
  void speeds(double cruise, double max_turn, double max_swing, double braking,
              std::array<double, Plan::kMaxPath>& top) const {
    double next = plan_.end_speed * plan_.end_speed;  // Squared.
    for (std::size_t i = path_.size(); i-- > 0;) {
      const double bent = i + 1 < path_.size() ? std::fabs(bend(i)) : 0.0;
      double own = bent * cruise > max_turn ? max_turn / bent : cruise;
      if (max_swing > 0 && i + 2 < path_.size()) {
        const double swing = std::fabs(bend(i + 1) - bend(i)) / spacing_;
        if (swing * own > max_swing) own = max_swing / swing;
      }
      if (i + 1 == path_.size()) own = std::min(own, plan_.end_speed);
      const double squared = std::min(own * own, next + 2 * braking * spacing_);
      top[i] = std::sqrt(squared);
      next = squared;
    }
  }

 private:
  /// The pose before the point, and the fraction of the distance to the next pose, [0, 1].
  struct Spot {
    std::size_t index;
    double part;
  };
  Spot spot() const {
    const double exact = at_ / spacing_;
    const std::size_t i = std::min(static_cast<std::size_t>(exact), path_.size() - 2);
    return {i, std::clamp(exact - static_cast<double>(i), 0.0, 1.0)};
  }
  double bend(std::size_t i) const { return wrap_angle(path_[i + 1].yaw - path_[i].yaw) / spacing_; }

  const Plan& plan_;
  std::span<const Pose2> path_;
  double spacing_{};
  double at_{};
};

template <class Model>
class IlqrController final : public Controller {
  using Solver = Ilqr<Model>;

 public:
  IlqrController(const Platform& platform, Model model, const typename Solver::Limits& limits)
      : Controller(platform), model_(model), solver_(model, limits, {}, kLookAheadStep) {}

 protected:
  Twist2 track(const Pose2& odom, const Place& place, double dt) override {
    if (place.remaining < kShortestPath && plan().end_speed <= 0) {
      rest();
      return {};
    }
    refer(odom, place);
    typename Solver::X start;
    start.template head<3>() << odom.x, odom.y, odom.yaw;
    start.template tail<Model::kVelocities>() = model_.inverse(command());
    // The velocity of a car at rest does not define its steering angle.
    if constexpr (std::is_same_v<Model, model::Car>) start[4] = steering();
    solver_.solve(start, references_);
    const typename Solver::V first =
        start.template tail<Model::kVelocities>() + dt * solver_.controls().front();
    const Eigen::Vector3d twist = model_.twist(first);
    const double speed = std::hypot(twist[0], twist[1]);
    const double keep = speed > platform().max_speed ? platform().max_speed / speed : 1.0;
    return {keep * twist[0], keep * twist[1],
            std::clamp(twist[2], -platform().max_turn, platform().max_turn)};
  }

  void rest() override { solver_.reset(); }

 private:
  /// Computes the reference pose and velocity of each step: along the path, no faster than the plan, the
  /// path's curvature, its end and the platform's acceleration allow.
  void refer(const Pose2& odom, const Place& place) {
    Walk walk(plan(), place.nearest, odom);
    const double sign = plan().reverse ? -1.0 : 1.0;
    const double cruise = std::min(plan().max_speed, platform().max_speed);
    // While the front wheels turn at their rate, the curvature changes by at least rate / wheelbase each
    // second.
    const double swing =
        platform().drive == Drive::car ? platform().steering_rate / platform().wheelbase : 0.0;
    walk.speeds(cruise, kTurnShare * platform().max_turn, swing, kBrakingShare * platform().max_acceleration,
                top_);
    double speed = std::min(cruise, std::hypot(command().vx, command().vy));
    for (Reference& r : references_) {
      speed = std::min(walk.at(top_), speed + platform().max_acceleration * kLookAheadStep);
      speed = std::max(speed, kCreepSpeed);
      walk.advance(speed * kLookAheadStep);
      r.pose = walk.pose();
      const double turn = walk.curvature() * speed;
      r.twist = walk.remaining() > 0 || plan().end_speed > 0 ? Twist2{sign * speed, 0, turn} : Twist2{};
    }
  }

  Model model_;
  Solver solver_;
  std::array<Reference, Solver::kHorizon> references_{};
  std::array<double, Plan::kMaxPath> top_{};
};

}  // namespace

std::unique_ptr<Controller> make_ilqr_controller(const Platform& p) {
  if (p.sideways()) {
    const Ilqr<model::Holonomic>::Limits limits{
        {p.max_speed, p.max_speed, p.max_turn},
        {p.max_acceleration, p.max_acceleration, p.max_turn_acceleration}};
    return std::make_unique<IlqrController<model::Holonomic>>(p, model::Holonomic{}, limits);
  }
  if (p.drive == Drive::car) {
    const Ilqr<model::Car>::Limits limits{
        {p.max_speed, p.max_steering}, {p.max_acceleration, p.steering_rate}, {0.0, 1.0}};
    return std::make_unique<IlqrController<model::Car>>(p, model::Car{p.wheelbase}, limits);
  }
  const Ilqr<model::Unicycle>::Limits limits{{p.max_speed, p.max_turn},
                                             {p.max_acceleration, p.max_turn_acceleration}};
  return std::make_unique<IlqrController<model::Unicycle>>(p, model::Unicycle{}, limits);
}

}  // namespace adit::nav
