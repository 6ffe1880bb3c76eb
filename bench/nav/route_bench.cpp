// SPDX-License-Identifier: Apache-2.0
// The global planner in a world that it does not know: 3 x 3 blocks of 8 m, corridors of 3.2 m, from one
// corner to the opposite one at 2 m/s. Time and way of the whole drive; thread-CPU time of what the map takes
// from a scan (16 x 900 points) with the graph, of a search, and what both hold; the same of the coverage map
// of exploration. FAR planner in the same world: 33.7 s, 60 m.
#include <algorithm>
#include <cstdio>

#include "bench/nav/calibration.hpp"
#include "nav/explore/coverage_map.hpp"
#include "tests/nav/route_drive.hpp"
#include "tests/nav/route_world.hpp"

namespace adit::nav {
namespace {

constexpr double kGoal = 35.2;  // m, both ways

struct Series {
  std::vector<double> values{};
  void add(double v) { values.push_back(v); }
  double mean() const {
    double sum = 0;
    for (const double v : values) sum += v;
    return sum / static_cast<double>(values.size());
  }
  double at(double share) {
    std::sort(values.begin(), values.end());
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
  }
};

bool run(unsigned seed) {
  test::RouteDrive drive(test::wheeled(), test::city(3, 8, 3.2), {1.6, 1.6, 0});
  drive.loop.columns = 900;
  drive.loop.random.seed(seed);
  Series update, search, cover;
  CoverageMap coverage;
  bool arrived = false;
  while (drive.loop.time < 60 && !arrived) {
    const Pose2 at = drive.loop.odometry();
    const auto scan = drive.loop.world.scan(drive.loop.truth, 0.5, drive.loop.rings, drive.loop.columns, 0.01,
                                            drive.loop.random);
    const double t0 = bench::thread_cpu_ms();
    drive.planner.add_scan(scan, Pose3::level(at, 0.0), drive.loop.time, true,
                           drive.loop.local_navigation.map().get());
    const double t1 = bench::thread_cpu_ms();
    const Route route = drive.planner.plan({at.x, at.y, 0}, {kGoal, kGoal, std::nan("")});
    const double t2 = bench::thread_cpu_ms();
    update.add(t1 - t0);
    search.add(t2 - t1);
    const double t3 = bench::thread_cpu_ms();
    coverage.add_scan(scan, {0, 0, 0.5}, Pose3::level(at, 0.0));
    cover.add(bench::thread_cpu_ms() - t3);
    if (!route.found()) return false;
    drive.next({kGoal, kGoal});
    drive.drive();
    arrived = drive.step.last && drive.loop.last.arrived;
  }
  const double memory = static_cast<double>(drive.planner.memory()) / 1e6;
  const bool good =
      arrived && drive.loop.time < 33.7 && search.at(0.5) < 0.5 && update.mean() < 8.0 && memory < 100;
  std::printf("| %u | %.1f | %.1f | %.2f | %.2f | %.2f | %.2f | %.2f | %.1f | %.2f | %.2f | %.2f | %s |\n",
              seed, drive.loop.time, drive.loop.driven, drive.loop.least_clearance, update.mean(),
              update.at(0.99), search.at(0.5), search.at(0.99), memory, cover.mean(), cover.at(0.99),
              static_cast<double>(coverage.memory()) / 1e6, good ? "ok" : "MISSED");
  return good;
}

}  // namespace
}  // namespace adit::nav

int main() {
  std::printf(
      "| seed | s | m | clearance, m | update, ms (mean) | 99 %% | search, ms (median) | 99 %% | MB | "
      "coverage, ms (mean) | 99 %% | MB | |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
  bool good = true;
  for (unsigned seed = 1; seed <= 10; ++seed) good &= adit::nav::run(seed);
  return good ? 0 : 1;
}
