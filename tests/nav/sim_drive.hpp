// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <deque>
#include <memory>
#include <optional>

#include "nav/control/controller.hpp"
#include "nav/local_navigation.hpp"
#include "nav/monitor/held_watch.hpp"
#include "sim/world/simulation.hpp"
#include "tests/nav/box_world.hpp"
#include "tests/nav/scanned_monitor.hpp"

namespace adit::nav::test {

/// Robots in the simulated world, noisy odometry and lidar, people who walk: scan and plan at 10 Hz,
/// velocities at 20 Hz, each as late as in the agent. What a rehearsal shows, without the agents.
class SimDrive {
 public:
  struct Robot {
    LocalNavigation local_navigation;
    std::unique_ptr<Controller> controller;
    ScannedMonitor monitor;
    Pose2 start{};
    std::optional<Eigen::Vector2d> goal{};  ///< World frame, m.
    bool arrived{false};
    Plan plan{};
    std::size_t moving{0};  ///< Movers reported, over all scans.
    sim::Simulation::ScanJob job{};
    Pose2 scanned{};  ///< Its own pose at the scan.
    HeldWatch held{};
  };

  SimDrive(std::shared_ptr<const sim::World> world, const std::vector<sim::RobotStart>& starts,
           const sim::SimulationParams& params)
      : simulation(sim::Simulation::create(std::move(world), starts, params).value()) {
    for (const sim::RobotStart& start : starts)
      robots.push_back({LocalNavigation(start.platform), make_controller("ilqr", start.platform).value(),
                        ScannedMonitor(start.platform), start.pose});
  }

  void step() {
    simulation.step();
    ++ticks;
    const double now = seconds(simulation.now());
    for (std::size_t n = 0; n < robots.size(); ++n) {
      Robot& r = robots[n];
      const std::size_t phase = (ticks + 3 * n) % 10;
      const Pose2 odom = simulation.odometry(n).pose();
      if (phase == 0) {
        r.job = simulation.scan(n);
        r.scanned = odom;
      }
      if (phase == 2 && r.job.world) {
        const auto points = r.job.compute();
        const Pose3 body = Pose3::level(r.scanned, 0.0);
        r.monitor.look(points, body, now);
        r.local_navigation.add_scan(points, body, now);
        r.moving += r.local_navigation.movers().size();
        if (!r.goal) continue;
        const Target target = Target::to(r.start.inverse() * *r.goal);
        r.plan = r.local_navigation.plan(target, odom, now);
      }
      if (phase == 4 && r.goal) {
        r.controller->set_plan(r.plan);
        r.arrived = r.arrived || r.plan.arrived;
      }
      if ((ticks + n) % 5 != 0) continue;
      const Twist2 moves = r.controller->command();
      const auto verdict = r.monitor.check(r.controller->follow(odom, 0.05), odom, now,
                                           CollisionMonitor::Policy::stop, {moves});
      if (verdict.cause != CollisionMonitor::Cause::none) r.controller->sent(verdict.velocity);
      simulation.command(n, verdict.velocity);
      r.held.look(verdict.cause == CollisionMonitor::Cause::stopped, odom.position(), now);
    }
  }
  /// Until all that have a goal have arrived, or for so long.
  bool drive(double seconds) {
    for (int n = 0; n < 100 * seconds; ++n) {
      step();
      bool all = true;
      for (const Robot& r : robots) all &= !r.goal || r.arrived;
      if (all) return true;
    }
    return false;
  }

  sim::Simulation simulation;
  std::vector<Robot> robots{};
  std::size_t ticks{0};
};

}  // namespace adit::nav::test
