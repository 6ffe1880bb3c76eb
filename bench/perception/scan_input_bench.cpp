// SPDX-License-Identifier: Apache-2.0
// Scan input: unpacking and preparing one sweep of 16 rings x 900 columns with times, on a body that drives
// and turns.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstring>

#include "perception/input/point_layout.hpp"
#include "perception/input/scan_input.hpp"

namespace adit::perception {
namespace {

constexpr std::uint64_t kStart = 1'000'000'000'000;  // ns
constexpr int kRings = 16, kColumns = 900;
constexpr std::uint32_t kStep = 24;

std::vector<std::uint8_t> packed() {
  std::vector<std::uint8_t> data(std::size_t{kStep} * kRings * kColumns);
  std::uint8_t* at = data.data();
  for (int column = 0; column < kColumns; ++column)
    for (int ring = 0; ring < kRings; ++ring, at += kStep) {
      const double azimuth = 2 * M_PI * column / kColumns, elevation = (-15 + 2 * ring) * M_PI / 180;
      const float place[3]{static_cast<float>(8 * std::cos(azimuth)),
                           static_cast<float>(8 * std::sin(azimuth)),
                           static_cast<float>(8 * std::tan(elevation))};
      const float time = 0.1f * static_cast<float>(column) / kColumns;
      const auto number = static_cast<std::uint16_t>(ring);
      std::memcpy(at, place, 12);
      std::memcpy(at + 12, &time, 4);
      std::memcpy(at + 20, &number, 2);
    }
  return data;
}

void scan_input(benchmark::State& state) {
  Platform platform;
  platform.lidars = {LidarConfig{.mounting = {.z = 0.5}}};
  ScanInput input(platform);
  const std::vector<PointField> fields{{"x", 0, 7},  {"y", 4, 7},          {"z", 8, 7},
                                       {"t", 12, 7}, {"intensity", 16, 7}, {"ring", 20, 4}};
  const auto layout = PointLayout::of(fields, kStep).value();
  const auto data = packed();
  const PoseFunction pose = [](std::uint64_t stamp) -> Result<Pose3> {
    const double t = static_cast<double>(stamp - kStart) * 1e-9;
    return Pose3::level({2 * t, 0, 1.5 * t}, 0);
  };
  for (auto _ : state) {
    auto sweep = layout.unpack(data, std::uint64_t{kRings} * kColumns, kStart, 0.1);
    auto scan = input.add(*sweep, 0, "lidar", pose);
    if (!scan || !*scan || !(*scan)->deskewed) state.SkipWithError("no scan");
    benchmark::DoNotOptimize(scan);
  }
}
BENCHMARK(scan_input)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace adit::perception

BENCHMARK_MAIN();
