// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "nav/control/controller.hpp"
#include "nav/local_navigation.hpp"
#include "nav/monitor/held_watch.hpp"
#include "nav/recovery/recovery.hpp"
#include "tests/nav/box_world.hpp"
#include "tests/nav/scanned_monitor.hpp"

namespace adit::nav::test {

/// A robot in a box world: scan and plan at 10 Hz, controller and collision monitor at 50 Hz, as the agent
/// calls them.
struct ClosedLoop {
  BoxWorld world{};
  Platform platform{wheeled()};
  Pose2 truth{};
  Pose2 bias{};        ///< The odometry is the truth with this offset alone (world frame).
  double noise{0.01};  ///< Standard deviation of ranges, m.
  int rings{16}, columns{360};
  std::mt19937 random{7};
  LocalNavigation local_navigation{platform};
  std::unique_ptr<Controller> controller;
  Controller& follower;
  ScannedMonitor monitor;

  Plan last{};
  double time{0};
  double least_clearance{10};
  double driven{0}, fastest{0}, steepest{0};  ///< In m, m/s, m/s2.
  int blocked_cycles{0}, held_steps{0}, slowed_steps{0};
  HeldWatch held{};
  Recovery recovery{};
  std::uint64_t goals{1};  ///< Number of the goal of drive().
  Eigen::Vector2d driven_to{0, 0};
  static constexpr double kHeldAfter = 1.5;  ///< Default of the agent, s.

  ClosedLoop(const Platform& p, BoxWorld w, const Pose2& start, const std::string& tracks = "ilqr")
      : world(std::move(w)),
        platform(p),
        truth(start),
        local_navigation(p),
        controller(make_controller(tracks, p).value()),
        follower(*controller),
        monitor(p) {}

  Pose2 odometry() const { return {truth.x + bias.x, truth.y + bias.y, truth.yaw}; }

  /// One cycle towards a goal on a route, or of what the recovery asks for instead. `route`: its number and
  /// what is left of it; no route: nothing is driven.
  RecoveryState recovering_cycle(const Target& goal, RecoveryInput in) {
    const Target target = recovery.target(goal);
    const bool stands = recovery.gave_up() || recovery.state() == RecoveryState::replan;
    cycle(target, !stands);
    in.take(last);
    in.held = held.held(time, kHeldAfter);
    in.at = odometry().position();
    in.stamp_s = time;
    return recovery.look(in);
  }

  /// One planner cycle and the five follower steps until the next; `follows`: the plan is driven.
  void cycle(const Target& target, bool follows = true) {
    const Pose2 odom = odometry();
    const auto scan = world.scan(truth, platform.lidar_height, rings, columns, noise, random);
    local_navigation.add_scan(scan, Pose3::level(odom, 0.0), time);
    monitor.look(scan, Pose3::level(odom, 0.0), time);
    last = local_navigation.plan(target, odom, time);
    blocked_cycles +=
        last.blocked && (target.kind == Target::Kind::goal || target.kind == Target::Kind::direction);
    follower.set_plan(follows ? last : Plan{});
    for (int i = 0; i < 5; ++i) {
      constexpr double kDt = 0.02;
      const Twist2 before = follower.command();
      const auto verdict = monitor.check(follower.follow(odometry(), kDt), odometry(), time,
                                         CollisionMonitor::Policy::stop, {before});
      const Twist2 v = verdict.velocity;
      if (verdict.cause != CollisionMonitor::Cause::none) follower.sent(v);
      held_steps += verdict.cause == CollisionMonitor::Cause::stopped;
      held.look(verdict.cause == CollisionMonitor::Cause::stopped, odometry().position(), time);
      slowed_steps += verdict.cause == CollisionMonitor::Cause::slowed;
      steepest = std::max(steepest, std::hypot(v.vx - before.vx, v.vy - before.vy) / kDt);
      fastest = std::max(fastest, std::hypot(v.vx, v.vy));
      driven += std::hypot(v.vx, v.vy) * kDt;
      const Pose2 axle{platform.rear_axle(), 0, 0};  // that a car turns about
      truth = truth * axle.inverse() * Pose2{v.vx * kDt, v.vy * kDt, (1 - platform.turn_slip) * v.wz * kDt} *
              axle;
      time += kDt;
      least_clearance = std::min(least_clearance, world.clearance(platform, truth));
    }
  }

  /// Until the plan says `arrived` and the robot stands, or for so many seconds; true when it arrived.
  bool drive(const Target& target, double seconds) {
    const double end = time + seconds;
    while (time < end) {
      if (target.kind != Target::Kind::goal) {
        cycle(target);
      } else {
        if ((target.goal - driven_to).norm() > 0.1) ++goals;
        driven_to = target.goal;
        const double left = (target.goal - odometry().position()).norm();
        recovering_cycle(target, {.goal = goals, .route = 1, .left = left});
        if (recovery.take_ask() != RouteAsk::none) recovery.replanned();
      }
      if (last.arrived && follower.command().zero()) return true;
    }
    return false;
  }
  double distance_to(double x, double y) const { return std::hypot(truth.x - x, truth.y - y); }
};

}  // namespace adit::nav::test
