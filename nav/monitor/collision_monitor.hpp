// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <limits>
#include <memory>

#include "nav/monitor/obstacle_detector.hpp"

namespace adit::nav {

/// Present motion of the robot by its odometry, at the centre of rotation: a car's rear axle. Without values
/// it is unknown.
struct Driven {
  Twist2 velocity{};
  /// Maximum speed that follows from the commands, m/s.
  double commanded{std::numeric_limits<double>::infinity()};
};

/// The last check of every velocity command, based only on the newest scan and the odometry: it is
/// independent of map, planner and controller. An ObstacleDetector, which may run on another thread, works
/// out each scan; a check takes time in proportion to the obstacles near the body. The monitor sweeps the
/// footprint along the arc of the commanded velocity and scales it so that the robot can brake before the
/// body, with a margin, touches an obstacle: far away the full velocity passes, nearer less (the slow zone),
/// at the margin none (the stop zone). Both zones grow with the speed and bend with the arc. Obstacles that
/// are already inside the margin may not get deeper: a robot in contact can leave, and obstacles behind it do
/// not matter to a robot that drives ahead.
///
/// Movers, found by the detector's own tracker, are assumed to keep their velocity: the robot brakes so that
/// it is stationary when they meet, and may always drive away from a mover or where it does not come.
///
/// After Nav2's collision monitor, without its fixed polygons: these stop a robot because of obstacles that
/// it is driving away from, and hold it there (ros-navigation/navigation2, issues 3313 and 3748).
class CollisionMonitor {
 public:
  /// Reaction to a collision ahead, and to a stale scan.
  enum class Policy : std::uint8_t {
    stop,       ///< Autonomous modes and smart joystick: both stop the robot.
    limit,      ///< Manual mode: both limit the speed, and neither stops.
    stop_seen,  ///< Manual mode, if the platform file asks for it: an obstacle stops, a stale scan limits.
  };
  /// Reason why a velocity was changed. `tilted`: the body tilts so far that it may tip over.
  enum class Cause : std::uint8_t { none, slowed, stopped, stale, tilted };
  /// Result of a check: the velocity that is safe.
  struct Verdict {
    Twist2 velocity{};
    Cause cause{Cause::none};  ///< `stopped`: no motion is possible; under Policy::limit it continues slowly.
  };

  static constexpr double kStale = 0.5;  ///< An older scan is stale, s.

  explicit CollisionMonitor(const Platform& platform);

  /// Makes a detector of the obstacles that this monitor needs.
  ObstacleDetector make_detector() const;
  /// Takes what the newest scan shows; null is ignored.
  void see(std::shared_ptr<const DetectedObstacles> seen);
  /// What the newest scan showed.
  const DetectedObstacles& seen() const { return *seen_; }
  /// Sets further places, odometry frame, m, that the body must not touch, until the next call. They bind the
  /// check of each velocity. At most NearPoints::kMax count.
  void set_border(std::span<const Eigen::Vector2f> places);
  /// Returns the part of `wanted` (body frame) that is safe for a robot at `odom` at the time `now_s`. If the
  /// robot cannot slow down as fast as the arc of `wanted` requires, it brakes on its present arc: faster
  /// than `wanted`, but slower than it `drives` and, whatever the odometry reports, slower than its commands.
  Verdict check(const Twist2& wanted, const Pose2& odom, double now_s, Policy policy,
                const Driven& drives = {}) const;
  /// Returns a motion to replace one that check() stopped, with no part of the body faster than 0.1 m/s: its
  /// translation alone, its rotation alone, or both with half the rotation, the first of them without a
  /// limit; else zero. For example, a robot beside a wall that cannot swing its rear drives straight ahead
  /// first.
  Twist2 instead_of(const Twist2& stopped, const Pose2& odom, double now_s) const;
  /// Forgets the scan, for example after a jump of the odometry: scans are stale until the next one.
  void clear();
  bool fresh(double now_s) const { return now_s - seen_->stamp_s <= kStale; }

 private:
  /// Time for which `velocity` can be driven until the body touches an obstacle, s, at most `horizon`.
  double free_time(std::span<const NearPoints::Place> places, const Twist2& velocity, const Pose2& odom,
                   double horizon) const;
  /// Fraction of `wanted`, [0, 1], that can be driven and braked before the body touches a static obstacle
  /// or, by its own motion, a mover.
  double speed_scale(const Twist2& wanted, const Pose2& odom, double now_s) const;
  /// The same for movers alone; braking takes `brake` s from the full `wanted`.
  double speed_scale_before_movers(const Twist2& wanted, const Pose2& odom, double now_s, double brake) const;
  Twist2 limited(const Twist2& wanted) const;
  double rim_speed(const Twist2& velocity) const;

  Platform platform_;
  Footprint body_, wide_;  ///< With the margins towards static obstacles and movers.
  std::vector<NearPoints::Place> border_{};
  std::shared_ptr<const DetectedObstacles> seen_;  ///< Never null.
};

}  // namespace adit::nav
