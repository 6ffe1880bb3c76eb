// SPDX-License-Identifier: Apache-2.0
#include "nav/monitor/collision_monitor.hpp"

#include <algorithm>
#include <utility>

namespace adit::nav {
namespace {

constexpr double kMargin = 0.02;       ///< Safety margin around the footprint, m.
constexpr double kMoverMargin = 0.10;  ///< Safety margin towards movers, m.
constexpr double kReaction = 0.15;     ///< Latency before braking begins, s.
// Fraction of the platform's acceleration that is assumed for braking.
constexpr double kBrakingShare = 0.75;
/// Speed limit of any part of the body when a robot is limited and not stopped, m/s.
constexpr double kLimitSpeed = 0.3;
constexpr double kStride = 0.03;  ///< Distance between the poses of a sweep, m.
constexpr int kMaxStrides = 160;  ///< Maximum number of poses of a sweep.
/// A smaller change does not count as deeper, m: sliding along a wall is allowed.
constexpr float kDeeper = 0.002f;
constexpr double kCreep = 0.02;   ///< A lower speed counts as stationary, m/s.
constexpr int kShares = 10;       ///< Number of fractions of a velocity that are tried against movers.
constexpr double kInstead = 0.1;  ///< Speed of the body's fastest part in a replacement motion, m/s.
/// A slower robot stops within a hand's width, and its odometry may be noise, m/s.
constexpr double kSlow = 0.2;
constexpr double kFastest = 1.5;  ///< Factor on the platform's speed above which a velocity is implausible.
constexpr double kNext = 0.05;    ///< Period of the checks, s.
constexpr double kTick = 0.06;    ///< Step of the prediction of movers, s.
constexpr std::size_t kMaxMoving = Tracker::kMax * Mover::kMax;

Twist2 scaled(const Twist2& t, double by) { return {by * t.vx, by * t.vy, by * t.wz, t.vz}; }

double speed_of(const Twist2& t) { return std::hypot(t.vx, t.vy); }

double reach_of(const Platform& p) {
  return std::hypot(p.length, p.width) / 2 + kMargin + p.max_speed * kReaction +
         p.max_speed * p.max_speed / (2 * kBrakingShare * p.max_acceleration) + 0.1;
}

}  // namespace

CollisionMonitor::CollisionMonitor(const Platform& platform)
    : platform_(platform),
      body_(Footprint(platform).grown(kMargin, kMargin)),
      wide_(Footprint(platform).grown(kMoverMargin, kMoverMargin)),
      seen_(std::make_shared<const DetectedObstacles>()) {}

ObstacleDetector CollisionMonitor::make_detector() const { return {platform_, reach_of(platform_)}; }

void CollisionMonitor::see(std::shared_ptr<const DetectedObstacles> seen) {
  if (seen) seen_ = std::move(seen);
}

void CollisionMonitor::set_border(std::span<const Eigen::Vector2f> places) {
  border_.clear();
  for (const Eigen::Vector2f& place : places.first(std::min(places.size(), NearPoints::kMax)))
    border_.push_back({.x = place.x(), .y = place.y()});
}

void CollisionMonitor::clear() { seen_ = std::make_shared<const DetectedObstacles>(); }

Twist2 CollisionMonitor::limited(const Twist2& wanted) const {
  const double fastest = rim_speed(wanted);
  return fastest > kLimitSpeed ? scaled(wanted, kLimitSpeed / fastest) : wanted;
}

// Speed of the body's fastest part, m/s.
double CollisionMonitor::rim_speed(const Twist2& velocity) const {
  return std::max(speed_of(velocity), std::fabs(velocity.wz) * body_.radius());
}

Twist2 CollisionMonitor::instead_of(const Twist2& stopped, const Pose2& odom, double now_s) const {
  if (!fresh(now_s)) return {};
  const bool both = speed_of(stopped) > 0 && stopped.wz != 0;
  if (!both) return {};
  for (Twist2 part : {Twist2{stopped.vx, stopped.vy, 0}, Twist2{0, 0, stopped.wz},
                      Twist2{stopped.vx, stopped.vy, stopped.wz / 2}}) {
    if (speed_of(part) == 0 && !platform_.turns_on_spot()) continue;
    if (const double fastest = rim_speed(part); fastest > kInstead) part = scaled(part, kInstead / fastest);
    if (speed_scale(part, odom, now_s) >= 1) return part;
  }
  return {};
}

double CollisionMonitor::speed_scale(const Twist2& wanted, const Pose2& odom, double now_s) const {
  // Braking time from the full `wanted`; from a fraction of it, that fraction of the time.
  const double brake = std::max(speed_of(wanted) / (kBrakingShare * platform_.max_acceleration),
                                std::fabs(wanted.wz) / (kBrakingShare * platform_.max_turn_acceleration));
  const double horizon = kReaction + brake / 2;
  double free = free_time(seen_->places, wanted, odom, horizon);
  if (!border_.empty()) free = std::min(free, free_time(border_, wanted, odom, horizon));
  const double k = speed_scale_before_movers(wanted, odom, now_s, brake);
  if (free >= horizon) return k;
  // The fraction k whose stopping distance, k reaction + k^2 brake / 2 (in s of driving `wanted`), fits.
  return std::min(k, (std::sqrt(kReaction * kReaction + 2 * brake * free) - kReaction) / brake);
}

CollisionMonitor::Verdict CollisionMonitor::check(const Twist2& wanted, const Pose2& odom, double now_s,
                                                  Policy policy, const Driven& drives) const {
  if (wanted.zero()) return {wanted, Cause::none};
  if (!fresh(now_s)) return {policy == Policy::stop ? Twist2{} : limited(wanted), Cause::stale};
  // An operator may have to drive it down manually.
  if (seen_->tilted) return {policy == Policy::stop ? Twist2{} : limited(wanted), Cause::tilted};
  const double k = speed_scale(wanted, odom, now_s);
  if (k >= 1) return {wanted, Cause::none};
  const bool is_stopped = k * rim_speed(wanted) < kCreep;
  const Cause cause = is_stopped ? Cause::stopped : Cause::slowed;
  const Twist2 allowed = is_stopped ? Twist2{} : scaled(wanted, k);
  if (policy == Policy::limit) {
    const Twist2 slow = limited(wanted);
    return {speed_of(allowed) + std::fabs(allowed.wz) > speed_of(slow) + std::fabs(slow.wz) ? allowed : slow,
            cause};
  }
  // A robot that turns towards an obstacle at speed cannot slow down to the speed for that arc in time.
  const double lost = platform_.max_acceleration * kNext, by_odometry = speed_of(drives.velocity);
  const Twist2 moves = by_odometry > drives.commanded
                           ? scaled(drives.velocity, drives.commanded / by_odometry)
                           : drives.velocity;
  const double speed = speed_of(moves);
  const bool ahead = moves.vx * wanted.vx + moves.vy * wanted.vy > 0;
  if (ahead && speed > kSlow && by_odometry <= kFastest * platform_.max_speed &&
      speed - speed_of(allowed) > lost) {
    const double by_brakes = 1 - kBrakingShare * lost / speed;
    const double braked = std::min(by_brakes, speed_scale(moves, odom, now_s));
    Twist2 braking = scaled(moves, braked);
    braking.vz = wanted.vz;
    // Compensates the slip of tracks.
    braking.wz = std::clamp(braking.wz / (1 - platform_.turn_slip), -platform_.max_turn, platform_.max_turn);
    if (braked * speed > speed_of(allowed)) return {braking, Cause::slowed};
  }
  return {allowed, cause};
}

double CollisionMonitor::free_time(std::span<const NearPoints::Place> places, const Twist2& velocity,
                                   const Pose2& odom, double horizon) const {
  const double radius = body_.radius();
  const double rim_speed = speed_of(velocity) + std::fabs(velocity.wz) * radius;
  const int steps = std::clamp(static_cast<int>(std::ceil(rim_speed * horizon / kStride)), 1, kMaxStrides);
  const double dt = horizon / steps;

  const IntoPose into(odom);
  const double wide = radius + NearPoints::kMaxUncertainty;
  const auto far = static_cast<float>(wide + speed_of(velocity) * horizon);
  struct Point {
    float x, y, depth;
  };
  // The points within reach; the sweep ends at the first one that it meets.
  std::array<Point, NearPoints::kMax> points;
  std::size_t count = 0;
  for (const NearPoints::Place& place : places) {
    const float dx = place.x - into.x, dy = place.y - into.y;
    if (dx * dx + dy * dy > far * far) continue;
    const Eigen::Vector2f at = into.turn(dx, dy);
    // The margin grows with the uncertainty of places with few, noisy returns.
    points[count++] = {at.x(), at.y(),
                       std::max(0.0f, body_.depth(at) + place.uncertainty) + kDeeper - place.uncertainty};
  }
  if (count == 0) return horizon;

  Pose2 pose{};
  // A car turns about its rear axle, so base_link moves sideways too.
  const double sideways = velocity.vy + platform_.rear_axle() * velocity.wz;
  const Pose2 half{0, 0, velocity.wz * dt / 2};
  const auto reach = static_cast<float>(wide * wide);
  for (int i = 0; i < steps; ++i) {
    pose = pose * half * Pose2{velocity.vx * dt, sideways * dt, 0} * half;
    const IntoPose into_body(pose);
    for (std::size_t j = 0; j < count; ++j) {
      const float dx = points[j].x - into_body.x, dy = points[j].y - into_body.y;
      if (dx * dx + dy * dy > reach) continue;
      if (body_.depth(into_body.turn(dx, dy)) > points[j].depth) return i * dt;
    }
  }
  return horizon;
}

double CollisionMonitor::speed_scale_before_movers(const Twist2& wanted, const Pose2& odom, double now_s,
                                                   double brake) const {
  struct Point {
    float x, y, vx, vy;  // Relative to the robot now.
  };
  std::array<Point, kMaxMoving> points;
  std::size_t count = 0;
  const IntoPose into(odom);
  const auto age = static_cast<float>(now_s - seen_->stamp_s);
  const double longest = kReaction + brake;
  const auto own_way = static_cast<float>(wide_.radius() + speed_of(wanted) * longest);
  for (const Mover& mover : seen_->movers) {
    if (!mover.moves) continue;  // The scan shows it as a static obstacle.
    const Eigen::Vector2f& v = mover.velocity;
    const float far = own_way + v.norm() * static_cast<float>(longest);
    for (const Eigen::Vector2f& p : mover.surface()) {
      const float dx = p.x() + age * v.x() - into.x, dy = p.y() + age * v.y() - into.y;
      if (dx * dx + dy * dy > far * far) continue;
      const Eigen::Vector2f at = into.turn(dx, dy), velocity = into.turn(v.x(), v.y());
      points[count++] = {at.x(), at.y(), velocity.x(), velocity.y()};
    }
  }
  if (count == 0) return 1;
  const double sideways = wanted.vy + platform_.rear_axle() * wanted.wz;  // As above, for a car.
  const auto met = [&](double speed_scale) {
    const double braking = speed_scale * brake, end = kReaction + braking;
    const int steps = static_cast<int>(std::ceil(end / kTick));
    const auto radius2 = static_cast<float>(wide_.radius() * wide_.radius());
    const auto through = static_cast<float>(kMoverMargin);
    std::array<bool, kMaxMoving> gone{};
    Pose2 before{};
    for (int i = 1; i <= steps; ++i) {
      const double t = end * i / steps, late = std::max(0.0, t - kReaction);
      // Driven distance in s of driving `wanted`: first at the fraction, then braking.
      const double way = speed_scale * (t - late * late / (2 * std::max(braking, 1e-6)));
      const double half = wanted.wz * way / 2;
      const double chord = std::fabs(half) > 1e-6 ? way * std::sin(half) / half : way;
      const Pose2 pose =
          Pose2{0, 0, half} * Pose2{wanted.vx * chord, sideways * chord, 0} * Pose2{0, 0, half};
      const auto depth = [this](const Pose2& at, float x, float y) {
        return wide_.depth(IntoPose(at)(x, y));
      };
      for (std::size_t j = 0; j < count; ++j) {
        if (gone[j]) continue;
        const Point& p = points[j];
        const float x = p.x + static_cast<float>(t) * p.vx, y = p.y + static_cast<float>(t) * p.vy;
        const float dx = x - static_cast<float>(pose.x), dy = y - static_cast<float>(pose.y);
        if (dx * dx + dy * dy > radius2) continue;
        const float inside = depth(pose, x, y);
        if (inside <= 0) continue;
        // Stopping does not help against a mover that walks into a robot that does not get nearer by itself.
        if (inside - depth(before, x, y) > kCreep * end / steps) return true;
        gone[j] = inside > through;
      }
      before = pose;
    }
    return false;
  };
  for (int i = kShares; i > 0; --i)
    if (!met(static_cast<double>(i) / kShares)) return static_cast<double>(i) / kShares;
  return 0;
}

}  // namespace adit::nav
