// SPDX-License-Identifier: Apache-2.0
// Pictures of a simulated camera in a real building (geb079.bt) and in a room of boxes.
#include <benchmark/benchmark.h>

#include <array>
#include <filesystem>

#include "sim/world/camera.hpp"
#include "tests/folders/folders.hpp"

namespace {

using namespace adit;
using namespace adit::sim;

Result<World> building() {
  const std::array<std::filesystem::path, 3> folders{source_folder() + "/data/maps",
                                                     source_folder() + "/config",
                                                     "/usr/share/doc/liboctomap-dev/examples/data"};
  const auto found = find_map("geb079.bt", folders);
  return found ? load_octomap(*found) : Result<World>(found.error());
}

Result<World> boxes() {
  const std::array<Box, 6> boxes{Box{-0.5, 12.5, -4.5, -4, 0, 3}, {-0.5, 12.5, 4, 4.5, 0, 3},
                                 {-0.5, 0, -4, 4, 0, 3},          {12, 12.5, -4, 4, 0, 3},
                                 {5, 6, 1, 1.6, 0, 0.9},          {7, 7.4, -2.2, -1.8, 0, 2.2}};
  return make_box_world(boxes, 0, 3);
}

void picture(benchmark::State& state, Result<World> (*make)()) {
  auto world = make();
  if (!world) return state.SkipWithError(world.error().text.c_str());
  PictureJob job;
  job.world = std::make_shared<const World>(std::move(*world));
  job.T_world_camera.position = {5.0, -0.4, 0.5};
  job.width = static_cast<int>(state.range(0));
  job.height = job.width * 3 / 4;
  job.bodies = {{BodyKind::robot, {{8.5, -0.4, 0.3}, 0.0, 0.6, 0.5, 0.4}}};
  for (auto _ : state) benchmark::DoNotOptimize(job.render());
}
BENCHMARK_CAPTURE(picture, building, building)->Arg(160)->Arg(320)->Arg(640)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(picture, boxes, boxes)->Arg(160)->Arg(320)->Arg(640)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
