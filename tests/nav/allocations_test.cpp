// SPDX-License-Identifier: Apache-2.0
// A cycle of terrain and plan, a controller's step and the collision monitor allocate nothing once they are
// made.
#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include "nav/control/controller.hpp"
#include "nav/local_navigation.hpp"
#include "nav/monitor/collision_monitor.hpp"
#include "nav/planners/make_planner.hpp"
#include "nav/terrain/air_map.hpp"
#include "tests/nav/box_world.hpp"

namespace {
thread_local std::uint64_t allocations = 0;
}

void* operator new(std::size_t size) {
  ++allocations;
  if (void* p = std::malloc(size)) return p;
  throw std::bad_alloc();
}
void operator delete(void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }

namespace adit::nav::test {
namespace {

TEST(Allocations, NoneInACycle) {
  const BoxWorld world{{{3, 3.3, -1, 1}, {-3, 6, 2, 2.2}, {-3, 6, -2.2, -2}}};
  std::mt19937 random(4);
  const auto scan = world.scan({}, 0.5, 16, 360, 0.01, random);
  std::vector<ObstaclePoint> cells;
  for (const auto& p : scan)
    if (p.z() > 0.1f && p.norm() < 4) cells.push_back({p.x(), p.y(), p.x() > 1 ? 1.0f : 0.4f});
  std::vector<Platform> platforms{car(), aerial()};
  for (const std::string& name : planner_names()) {
    platforms.push_back(wheeled());
    platforms.back().planner = name;
  }
  for (const Platform& platform : platforms) {
    AirMap air(platform);
    const auto planner = make_planner(platform).value();
    const auto controller = make_controller(platform.controller, platform).value();
    CollisionMonitor monitor(platform);
    ObstacleDetector detector = monitor.make_detector();
    const auto cycle = [&](double time) {
      const Plan plan = planner->plan(Target::to({6, 0}), {}, cells, time);
      controller->set_plan(plan);
      air.add_scan(scan, {}, time);
      // Shares what the detector owns.
      monitor.see({std::shared_ptr<const DetectedObstacles>{}, &detector.look(scan, {}, time)});
      return monitor
          .check(controller->follow({}, 0.05), {}, time, CollisionMonitor::Policy::stop, {{0.5, 0, 0.3}})
          .velocity;
    };
    cycle(0);
    const std::uint64_t before = allocations;
    for (int i = 1; i < 20; ++i) cycle(0.1 * i);
    EXPECT_EQ(allocations, before) << platform.name << " " << platform.planner;
  }
}

TEST(Allocations, NoneInATerrainCycle) {
  // Crates, a kerb and an edge come and go as the robot drives.
  const BoxWorld world{{{3, 3.3, -1, 1}, {-3, 9, 2, 2.2}, {4, 9, -2.2, -1, 0.0, 0.06}, {-3, 9, -2.2, -2}}};
  std::mt19937 random(4);
  LocalNavigation local_navigation(wheeled());
  std::vector<std::vector<Eigen::Vector3f>> scans;
  for (int i = 0; i < 30; ++i) {
    scans.push_back(world.scan({0.05 * i, 0, 0}, 0.5, 16, 360, 0.01, random));
    if (i % 3 == 0)
      for (Eigen::Vector3f& p : scans.back())
        if (p.x() > 2) p.z() -= 1.0f;
  }
  std::uint64_t before = 0;
  for (int i = 0; i < 30; ++i) {
    if (i == 5) before = allocations;
    const Pose2 pose{0.05 * i, 0, 0};
    local_navigation.add_scan(scans[static_cast<std::size_t>(i)], Pose3::level(pose, 0), 0.1 * i);
    local_navigation.plan(Target::to({6, 0}), pose, 0.1 * i);
  }
  EXPECT_EQ(allocations, before);
}

}  // namespace
}  // namespace adit::nav::test
