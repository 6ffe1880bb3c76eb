// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <limits>

#include "nav/dynamic/tracker.hpp"
#include "nav/monitor/near_points.hpp"

namespace adit::nav {

struct CollisionMonitorParams {
  NearPointsParams points{};
  TrackerParams tracker{};
  double margin{0.02};         ///< kept around the footprint, m, [0, 0.2]
  double mover_margin{0.10};   ///< the same towards what moves, m, [0, 0.5]
  double reaction{0.15};       ///< a velocity goes on this long before braking begins, s, [0, 1]
  double braking_share{0.75};  ///< of the platform's acceleration, that slowing down counts on, (0, 1]
  double stale{0.5};           ///< an older scan shows nothing, s, (0, 10]
  double limit_speed{0.3};     ///< of any part of the body, where a robot is limited and not stopped, m/s
};

/// How a robot drives now; nothing: nobody knows.
struct Driven {
  Twist2 velocity{};  ///< by its odometry, of what it turns about: without a car's rear axle's share
  double told{
      std::numeric_limits<double>::infinity()};  ///< the speed that it may have by what it was told, m/s
};

/// The last word on a velocity, by the newest scan and the odometry alone: independent of map, planner and
/// controller, which it watches. It sweeps the footprint along the arc of the velocity that is asked for and
/// lets through as much of it as can be braked before the body, and a margin, touch what was seen: far off
/// everything, nearer less (the slow zone), at the margin nothing (the stop zone). Both zones grow with the
/// speed and bend with the arc. What is inside the margin already may not come deeper: a robot that touches
/// something can leave it, and what stands behind it does not matter to one that drives ahead.
///
/// What moves (it has a tracker of its own) is taken to go on as it does: the robot brakes in time to stand
/// when they meet, and may always drive away from it, or be where it does not come.
///
/// After Nav2's collision monitor, with fixed polygons replaced: they stop a robot for what it is driving
/// away from, and hold it there (ros-navigation/navigation2, issues 3313 and 3748).
class CollisionMonitor {
 public:
  /// What is done about a collision ahead, and about a scan that is too old.
  enum class Policy : std::uint8_t {
    stop,       ///< autonomous modes and smart joystick: both stop
    limit,      ///< manual: both limit the speed, neither ever stops
    stop_seen,  ///< manual, as the platform's file may ask for: what is seen stops, an old scan limits
  };
  /// `tilted`: the body leans so far that it may tip over.
  enum class Cause : std::uint8_t { none, slowed, stopped, stale, tilted };
  struct Verdict {
    Twist2 velocity{};
    Cause cause{Cause::none};  ///< `stopped`: nothing of it may be driven; under Policy::limit it is, slowly
  };

  explicit CollisionMonitor(const Platform& platform, const CollisionMonitorParams& params = {});

  /// The newest scan: points in base_link, m; the body in the odometry frame when it was taken; the time
  /// that it came, s.
  void look(std::span<const Eigen::Vector3f> points, const Pose3& body, double stamp_s);
  /// What may be driven of `wanted` (body frame) by a robot that is at `odom`, at `now_s`. Where it cannot
  /// lose as much speed as the arc of `wanted` needs, it brakes on the arc that it is on: faster than
  /// `wanted`, slower than it `drives` and, whatever its odometry says, than it was told.
  Verdict check(const Twist2& wanted, const Pose2& odom, double now_s, Policy policy,
                const Driven& drives = {}) const;
  /// What may be driven instead of a motion that check() stopped, no part of the body faster than 0.1 m/s:
  /// its translation alone, its turn alone, or with half the turn, the first of them that nothing limits;
  /// else zero. So a robot beside a wall that may not swing its rear drives straight ahead first.
  Twist2 instead_of(const Twist2& stopped, const Pose2& odom, double now_s) const;
  /// Forgets what was seen, as after a jump of the odometry: every scan is too old until the next one.
  void clear();
  bool fresh(double now_s) const { return now_s - stamp_s_ <= params_.stale; }

 private:
  /// How long `velocity` can be driven until the body touches something, s, at most `horizon`.
  double free_time(const Twist2& velocity, const Pose2& odom, double horizon) const;
  /// How much of `wanted`, 0 to 1, can be driven and braked before the body touches what stands, or, by its
  /// own motion, what moves.
  double share(const Twist2& wanted, const Pose2& odom, double now_s) const;
  /// The same of what moves; braking takes `brake` s from all of `wanted`.
  double share_before_movers(const Twist2& wanted, const Pose2& odom, double now_s, double brake) const;
  Twist2 limited(const Twist2& wanted) const;
  double rim(const Twist2& velocity) const;

  Platform platform_;
  CollisionMonitorParams params_;
  Footprint body_, wide_;  ///< with the margins towards what stands and what moves
  NearPoints near_;
  Tracker tracker_;
  double tilt_;         ///< Roll or pitch at which the body may tip over, rad.
  bool tilted_{false};  ///< At the newest scan.
  double stamp_s_{-std::numeric_limits<double>::infinity()};
};

}  // namespace adit::nav
