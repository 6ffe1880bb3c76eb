// SPDX-License-Identifier: Apache-2.0
// Ray casting and lidar scans in the map of a real building (geb079.bt), and its loading.
#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <filesystem>

#include "sim/world/chassis.hpp"
#include "sim/world/lidar.hpp"
#include "sim/world/noise.hpp"
#include "sim/world/sweep.hpp"
#include "tests/folders/folders.hpp"

namespace {

using namespace adit;
using namespace adit::sim;

std::filesystem::path map_file() {
  const std::array<std::filesystem::path, 3> folders{source_folder() + "/data/maps",
                                                     source_folder() + "/config",
                                                     "/usr/share/doc/liboctomap-dev/examples/data"};
  const auto found = find_map("geb079.bt", folders);
  return found ? *found : std::filesystem::path("geb079.bt");
}

void load(benchmark::State& state) {
  for (auto _ : state) {
    auto world = load_octomap(map_file());
    if (!world) return state.SkipWithError(world.error().text.c_str());
    benchmark::DoNotOptimize(world);
  }
}
BENCHMARK(load)->Unit(benchmark::kMillisecond);

void cast(benchmark::State& state) {
  const auto world = load_octomap(map_file());
  if (!world) return state.SkipWithError(world.error().text.c_str());
  Random random(1);
  std::array<Eigen::Vector3d, 4096> directions;
  for (Eigen::Vector3d& d : directions) {
    const double a = 2 * M_PI * random.uniform(), e = (random.uniform() - 0.5) * M_PI / 6;
    d = {std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e)};
  }
  const VoxelGrid::Start start = world->grid().locate({10.0, -0.2, 0.5});
  std::array<double, 4096> ranges;
  for (auto _ : state) {
    world->grid().cast(start, directions, 30.0, ranges);
    benchmark::DoNotOptimize(ranges);
  }
  state.SetItemsProcessed(state.iterations() * 4096);
}
BENCHMARK(cast);

void scan(benchmark::State& state) {
  const auto world = load_octomap(map_file());
  if (!world) return state.SkipWithError(world.error().text.c_str());
  const LidarPattern lidar(state.range(0) == 1 ? LidarParams::planar() : LidarParams{});
  const std::array<BodyBox, 2> others{BodyBox{{12.5, 0.0, 0.0}, 0.0, 0.8, 0.6, 0.5},
                                      BodyBox{{4.0, -0.2, 1.0}, 0.0, 0.9, 0.45, 0.6}};
  std::uint64_t seed = 0;
  for (auto _ : state) {
    const double x = 6.0 + 0.01 * static_cast<double>(seed % 400);
    benchmark::DoNotOptimize(lidar.scan(*world, others, Pose3::level({x, -0.2, 0.3}, 0.0), 0.5, ++seed));
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(lidar.size()));
}
BENCHMARK(scan)->ArgName("planar")->Arg(0)->Arg(1)->Unit(benchmark::kMicrosecond);

// The same with each column from a pose of its own: of a body that drives, turns and sways.
void sweep(benchmark::State& state) {
  auto world = load_octomap(map_file());
  if (!world) return state.SkipWithError(world.error().text.c_str());
  SweepJob job;
  job.world = std::make_shared<const World>(std::move(*world));
  job.lidar = std::make_shared<const LidarPattern>(LidarParams{});
  job.duration = 0.1;
  job.errors.noise = static_cast<double>(state.range(0));
  job.T_world_lidar.resize(11);
  job.others.assign(
      10, {BodyBox{{12.5, 0.0, 0.0}, 0.0, 0.8, 0.6, 0.5}, BodyBox{{4.0, -0.2, 1.0}, 0.0, 0.9, 0.45, 0.6}});
  for (auto _ : state) {
    const double x = 6.0 + 0.01 * static_cast<double>(job.seed++ % 400);
    for (int n = 0; n <= 10; ++n)
      job.T_world_lidar[n] = {{x + 0.01 * n, -0.2, 0.5},
                              Attitude{0, 0.02, 0.001 * n}.orientation(0.3 + 0.01 * n)};
    benchmark::DoNotOptimize(job.trace());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(job.lidar->size()));
}
BENCHMARK(sweep)->ArgName("noise")->Arg(0)->Arg(1)->Unit(benchmark::kMicrosecond);

}  // namespace

BENCHMARK_MAIN();
