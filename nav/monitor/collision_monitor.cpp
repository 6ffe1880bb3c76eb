#include "nav/monitor/collision_monitor.hpp"

#include <algorithm>

namespace adit::nav {
namespace {

constexpr double kStride = 0.03;   ///< m between the poses of a sweep
constexpr int kMostStrides = 160;  ///< of one sweep
constexpr float kDeeper = 0.002f;  ///< m: less is not "deeper": sliding along a wall is allowed
constexpr double kCreep = 0.02;    ///< m/s: less than this is standing

Twist2 scaled(const Twist2& t, double by) { return {by * t.vx, by * t.vy, by * t.wz, t.vz}; }

double speed_of(const Twist2& t) { return std::hypot(t.vx, t.vy); }

double reach_of(const Platform& p, const CollisionMonitorParams& m) {
  return std::hypot(p.length, p.width) / 2 + m.margin + p.max_speed * m.reaction +
         p.max_speed * p.max_speed / (2 * m.braking_share * p.max_acceleration) + 0.1;
}

/// Below and above what flies there is air, not ground: all in the band that the body needs is an obstacle.
Platform without_ground(Platform platform) {
  if (platform.flies()) platform.step = 0.0;
  return platform;
}

NearPointsParams without_ground(const Platform& platform, NearPointsParams points) {
  constexpr double kBelow = 0.1;  // m
  if (platform.flies()) {
    points.slope = 0.0;
    points.rise = -kBelow;
  }
  return points;
}

}  // namespace

CollisionMonitor::CollisionMonitor(const Platform& platform, const CollisionMonitorParams& params)
    : platform_(platform),
      params_(params),
      body_(Footprint(platform).grown(params.margin, params.margin)),
      near_(without_ground(platform), reach_of(platform, params), without_ground(platform, params.points)) {}

void CollisionMonitor::look(std::span<const Eigen::Vector3f> points, const Pose3& body, double stamp_s) {
  near_.take(points, body, stamp_s);
  stamp_s_ = stamp_s;
}

Twist2 CollisionMonitor::limited(const Twist2& wanted) const {
  const double fastest = std::max(speed_of(wanted), std::fabs(wanted.wz) * body_.radius());
  return fastest > params_.limit_speed ? scaled(wanted, params_.limit_speed / fastest) : wanted;
}

CollisionMonitor::Verdict CollisionMonitor::check(const Twist2& wanted, const Pose2& odom, double now_s,
                                                  Policy policy) const {
  if (wanted.zero()) return {wanted, Cause::none};
  if (!fresh(now_s)) return {policy == Policy::stop ? Twist2{} : limited(wanted), Cause::stale};
  // Braking takes this long from all of `wanted`; from a share of it, that share of the time.
  const double brake =
      std::max(speed_of(wanted) / (params_.braking_share * platform_.max_acceleration),
               std::fabs(wanted.wz) / (params_.braking_share * platform_.max_turn_acceleration));
  const double horizon = params_.reaction + brake / 2;
  const double free = free_time(wanted, odom, horizon);
  if (free >= horizon) return {wanted, Cause::none};
  // The share k whose way to a stop, k reaction + k^2 brake / 2 (s of driving all of it), ends there.
  const double k =
      (std::sqrt(params_.reaction * params_.reaction + 2 * brake * free) - params_.reaction) / brake;
  const bool stands = k * std::max(speed_of(wanted), std::fabs(wanted.wz) * body_.radius()) < kCreep;
  const Cause cause = stands ? Cause::stopped : Cause::slowed;
  const Twist2 allowed = stands ? Twist2{} : scaled(wanted, k);
  if (policy != Policy::limit) return {allowed, cause};
  const Twist2 slow = limited(wanted);
  return {speed_of(allowed) + std::fabs(allowed.wz) > speed_of(slow) + std::fabs(slow.wz) ? allowed : slow,
          cause};
}

double CollisionMonitor::free_time(const Twist2& velocity, const Pose2& odom, double horizon) const {
  const double radius = body_.radius();
  const double rim = speed_of(velocity) + std::fabs(velocity.wz) * radius;
  const int steps = std::clamp(static_cast<int>(std::ceil(rim * horizon / kStride)), 1, kMostStrides);
  const double dt = horizon / steps;

  const auto c = static_cast<float>(std::cos(odom.yaw)), s = static_cast<float>(std::sin(odom.yaw));
  const auto x0 = static_cast<float>(odom.x), y0 = static_cast<float>(odom.y);
  const auto far = static_cast<float>(radius + speed_of(velocity) * horizon);
  struct Point {
    float x, y, depth;
  };
  std::array<Point, NearPoints::kMost> points;  // those in reach; the sweep ends at the first that it meets
  std::size_t count = 0;
  for (const NearPoints::Place& place : near_.places()) {
    const float dx = place.x - x0, dy = place.y - y0;
    if (dx * dx + dy * dy > far * far) continue;
    const float x = c * dx + s * dy, y = c * dy - s * dx;
    points[count++] = {x, y, std::max(0.0f, body_.depth(x, y)) + kDeeper};
  }
  if (count == 0) return horizon;

  Pose2 pose{};
  // A car turns about its rear axle, so that base_link goes sideways, too.
  const double sideways = velocity.vy + platform_.rear_axle() * velocity.wz;
  const Pose2 half{0, 0, velocity.wz * dt / 2};
  const auto reach = static_cast<float>(radius * radius);
  for (int i = 0; i < steps; ++i) {
    pose = pose * half * Pose2{velocity.vx * dt, sideways * dt, 0} * half;
    const auto pc = static_cast<float>(std::cos(pose.yaw)), ps = static_cast<float>(std::sin(pose.yaw));
    const auto px = static_cast<float>(pose.x), py = static_cast<float>(pose.y);
    for (std::size_t j = 0; j < count; ++j) {
      const float dx = points[j].x - px, dy = points[j].y - py;
      if (dx * dx + dy * dy > reach) continue;
      if (body_.depth(pc * dx + ps * dy, pc * dy - ps * dx) > points[j].depth) return i * dt;
    }
  }
  return horizon;
}

}  // namespace adit::nav
