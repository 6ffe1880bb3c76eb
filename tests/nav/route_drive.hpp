// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>

#include "nav/routing/route_follower.hpp"
#include "tests/nav/closed_loop.hpp"

namespace adit::nav::test {

/// A robot that is led by the route follower and its recovery, as the agent does it.
struct RouteDrive {
  ClosedLoop loop;
  RoutePlanner planner;
  RouteFollower route_follower;
  RouteStep step{};

  RouteDrive(const Platform& platform, BoxWorld world, const Pose2& start)
      : loop(platform, std::move(world), start), planner(platform), route_follower(platform) {}

  /// The map takes a scan, and the route follower says where to drive next.
  void look(const Eigen::Vector2d& goal) {
    const Pose2 at = loop.odometry();
    planner.add_scan(loop.world.scan(loop.truth, loop.platform.lidar_height, loop.rings, loop.columns,
                                     loop.noise, loop.random),
                     Pose3::level(at, 0.0), loop.time, true, loop.local_navigation.map().get());
    next(goal);
  }
  void next(const Eigen::Vector2d& goal) {
    const Pose2 at = loop.odometry();
    Recovery& recovery = loop.recovery;
    step = route_follower.step(planner, {.place = {at.x, at.y, 0},
                                         .goal = {goal.x(), goal.y(), std::nan("")},
                                         .goal_id = 1,
                                         .ask = recovery.take_ask(),
                                         .blocked_ahead = recovery.cause_ahead(),
                                         .stamp_s = loop.time});
    if (step.replanned) recovery.replanned();
  }
  /// Drives there for a tenth of a second.
  void drive() {
    RecoveryInput in = recovery_input(step);
    in.goal = 1;
    loop.recovering_cycle(target_of(step), in);
  }
  bool arrived() const { return step.last && loop.last.arrived && loop.follower.command().zero(); }

  /// True when it stands at the goal; false after so many seconds, or when there is no way.
  bool to(double x, double y, double seconds) {
    const double end = loop.time + seconds;
    while (loop.time < end) {
      look({x, y});
      if (step.state == RouteStep::State::unreachable) return false;
      drive();
      if (arrived()) return true;
    }
    return false;
  }
};

}  // namespace adit::nav::test
