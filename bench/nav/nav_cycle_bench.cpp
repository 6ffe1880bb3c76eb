// SPDX-License-Identifier: Apache-2.0
// The planner cycle: a lidar scan into the terrain map, and a plan. Thread-CPU time, median and 99th
// percentile, in ms and in units of the calibration loop of the same run; allocations a cycle. Goals: a fifth
// of what Falco and its terrain analysis take, 5, 8 and 11 units with 16, 32 and 64 beams; and 2 units with
// everything blocked, where it takes 20 with 10 000 points and 88 with 50 000.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <new>

#include "bench/nav/calibration.hpp"
#include "nav/local_navigation.hpp"
#include "tests/nav/box_world.hpp"

namespace {
std::uint64_t allocations = 0;  // one thread
}

void* operator new(std::size_t size) {
  ++allocations;
  if (void* p = std::malloc(size)) return p;
  throw std::bad_alloc();
}
void operator delete(void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }

namespace adit::nav {
namespace {

using test::Box;
using test::BoxWorld;

struct Case {
  const char* name;
  double goal_units;  ///< Upper limit of the median, calibration units.
  std::vector<std::vector<Eigen::Vector3f>> scans{};
  std::vector<Pose2> poses{};
  bool expect_blocked{false};
};

/// A drive of 24 cycles at 1 m/s down a 4 m wide corridor.
Case drive(const char* name, double goal_units, int rings, int columns, const std::vector<Box>& crates) {
  BoxWorld world{{{-10, 40, 2, 2.2}, {-10, 40, -2.2, -2}, {39, 40, -2, 2}, {-10, -9, -2, 2}}};
  world.boxes.insert(world.boxes.end(), crates.begin(), crates.end());
  Case c{name, goal_units};
  std::mt19937 random(3);
  for (int i = 0; i < 24; ++i) {
    c.poses.push_back({0.1 * i, 0, 0.02 * (i % 3)});
    c.scans.push_back(world.scan(c.poses.back(), 0.5, rings, columns, 0.01, random));
  }
  return c;
}

/// So many obstacle points all around, 0.5 to 3.5 m off: no path is free.
Case all_blocked(const char* name, int points) {
  Case c{name, 2.0};
  c.expect_blocked = true;
  std::mt19937 random(5);
  std::uniform_real_distribution<float> square(0.25f, 12.25f), turn(-3.14f, 3.14f), height(0.15f, 0.5f);
  for (int i = 0; i < 8; ++i) {
    c.poses.push_back({});
    auto& scan = c.scans.emplace_back();
    for (int j = 0; j < points; ++j) {
      const float r = std::sqrt(square(random)), a = turn(random);
      scan.emplace_back(r * std::cos(a), r * std::sin(a), height(random));
    }
  }
  return c;
}

bool run(const Case& c) {
  // Beside each case, so that both see the same machine.
  const double unit = bench::calibration_unit_ms();
  LocalNavigation local_navigation(test::wheeled());
  std::vector<double> scan_ms, total_ms;
  std::size_t points = 0, cells = 0, blocked = 0;
  std::uint64_t allocated = 0;
  double cpu = 0;
  constexpr int kWarm = 20, kCycles = 600;
  scan_ms.reserve(kCycles);
  total_ms.reserve(kCycles);
  for (int i = 0; i < kWarm + kCycles; ++i) {
    // To and fro along the drive, so that the map is always one that a robot would have.
    const std::size_t n = c.scans.size(), at = static_cast<std::size_t>(i) % (2 * n);
    const std::size_t k = at < n ? at : 2 * n - 1 - at;
    const std::uint64_t before = allocations;
    const double t0 = bench::thread_cpu_ms();
    local_navigation.add_scan(c.scans[k], Pose3::level(c.poses[k], 0.0), 0.1 * i);
    const double t1 = bench::thread_cpu_ms();
    const Plan plan = local_navigation.plan(Target::to({30, 0.5}), c.poses[k], 0.1 * i);
    const double t2 = bench::thread_cpu_ms();
    if (i < kWarm) continue;
    allocated += allocations - before;
    scan_ms.push_back(t1 - t0);
    total_ms.push_back(t2 - t0);
    cpu += t2 - t0;
    points += c.scans[k].size();
    cells += local_navigation.map()->places().size();
    blocked += plan.blocked;
  }
  std::sort(scan_ms.begin(), scan_ms.end());
  std::sort(total_ms.begin(), total_ms.end());
  const double median = total_ms[kCycles / 2], p99 = total_ms[kCycles * 99 / 100];
  const bool good =
      median / unit < c.goal_units && allocated == 0 && (blocked == kCycles) == c.expect_blocked;
  std::printf("%-28s %7zu %6zu %8.3f %8.3f %8.3f %8.3f %8.3f %8.3f %6.2f %9.1f %7.2f  %s\n", c.name,
              points / kCycles, cells / kCycles, unit, scan_ms[kCycles / 2], median, p99, median / unit,
              p99 / unit, c.goal_units, static_cast<double>(points) / cpu / 1e3,
              static_cast<double>(allocated) / kCycles, good ? "ok" : "MISSED");
  return good;
}

}  // namespace
}  // namespace adit::nav

int main() {
  using namespace adit::nav;
  const double begin = adit::bench::thread_cpu_ms();
  { const FalcoPlanner planner(test::wheeled()); }
  std::printf("libraries built in %.1f ms\n", adit::bench::thread_cpu_ms() - begin);
  std::printf("%-28s %7s %6s %8s %8s %8s %8s %8s %8s %6s %9s %7s\n", "case", "points", "cells", "unit ms",
              "scan ms", "cycle ms", "p99 ms", "units", "p99", "goal", "Mpoint/s", "allocs");
  std::vector<Box> crates;
  for (int i = 0; i < 24; ++i) {
    const double x = 1.6 + 0.9 * (i / 3), y = -1.3 + 1.3 * (i % 3) + 0.25 * (i / 3 % 2);
    crates.push_back({x, x + 0.3, y - 0.15, y + 0.15, 0.0, 0.3 + 0.1 * (i % 4)});
  }
  bool good = run(drive("free corridor, 16 x 900", 1.0, 16, 900, {}));
  good &= run(drive("cluttered, 16 x 900", 1.0, 16, 900, crates));
  good &= run(drive("cluttered, 16 x 1800", 1.0, 16, 1800, crates));
  good &= run(drive("cluttered, 32 x 1800", 1.6, 32, 1800, crates));
  good &= run(drive("cluttered, 64 x 1800", 2.2, 64, 1800, crates));
  good &= run(all_blocked("all blocked, 10 000 points", 10000));
  good &= run(all_blocked("all blocked, 50 000 points", 50000));
  return good ? 0 : 1;
}
