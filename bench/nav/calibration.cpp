// SPDX-License-Identifier: Apache-2.0
#include "bench/nav/calibration.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <ctime>
#include <random>
#include <unordered_map>
#include <vector>

namespace adit::bench {
namespace {

constexpr std::size_t kPoints = 28500;
constexpr int kRows = 161, kColumns = 451;

std::uint64_t voxel(const float* p) {
  const auto cell = [](float v) { return static_cast<std::uint64_t>(std::floor(v * 20) + 1e5); };
  return cell(p[0]) << 40 | cell(p[1]) << 20 | cell(p[2]);
}

std::size_t work(const std::vector<float>& points, std::unordered_map<std::uint64_t, int>& voxels,
                 std::vector<std::uint16_t>& grid) {
  voxels.reserve(30000);
  for (std::size_t i = 0; i < points.size(); i += 3) voxels[voxel(&points[i])]++;
  for (int heading = 0; heading < 36; ++heading) {
    const float c = std::cos(static_cast<float>(heading) * 0.1745f);
    const float s = std::sin(static_cast<float>(heading) * 0.1745f);
    for (std::size_t i = 0; i < points.size(); i += 12) {
      const int x = static_cast<int>((c * points[i] + s * points[i + 1]) * 10) + 80;
      const int y = static_cast<int>((c * points[i + 1] - s * points[i]) * 20) + 225;
      if (x >= 0 && x < kRows && y >= 0 && y < kColumns) grid[x * kColumns + y]++;
    }
  }
  return voxels.size() + grid[1000];
}

}  // namespace

double thread_cpu_ms() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) * 1e3 + static_cast<double>(t.tv_nsec) * 1e-6;
}

double calibration_unit_ms() {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> uniform(-10, 10);
  std::vector<float> points(3 * kPoints);
  for (float& v : points) v = uniform(random);
  std::vector<std::uint16_t> grid(kRows * kColumns, 0);
  std::vector<double> ms;
  volatile std::size_t sink = 0;
  for (int i = 0; i < 21; ++i) {
    std::unordered_map<std::uint64_t, int> voxels;  // its end is not part of the unit
    const double begin = thread_cpu_ms();
    sink = work(points, voxels, grid);
    ms.push_back(thread_cpu_ms() - begin);
  }
  std::sort(ms.begin(), ms.end());
  return sink > 0 ? ms[ms.size() / 2] : 0.0;
}

}  // namespace adit::bench
