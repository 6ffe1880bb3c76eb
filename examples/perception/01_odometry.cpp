// SPDX-License-Identifier: Apache-2.0
// The path of a lidar from its clouds alone: example_odometry CLOUDS OUT.tum
#include <cstdio>

#include "perception/odometry/lidar_odometry.hpp"
#include "sim/cloud/cloud_file.hpp"
#include "sim/cloud/tum_file.hpp"

using namespace adit;

namespace {

int failed(const Error& error) {
  std::fprintf(stderr, "%s\n", error.text.c_str());
  return 2;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return failed({Reason::bad_argument, "usage: example_odometry CLOUDS OUT.tum"});
  const auto files = sim::cloud_files(argv[1]);
  if (!files) return failed(files.error());
  constexpr double kNoise = 0.02, kNearest = 0.3, kFarthest = 100;  // m
  perception::LidarOdometry odometry(
      perception::LidarOdometryParams::clouds_only(kNoise, kNearest, kFarthest));
  constexpr std::uint64_t kFirst = 1'000'000'000, kPeriod = 100'000'000;  // ns
  std::vector<sim::StampedPose> path;
  for (const auto& file : *files) {
    const auto cloud = sim::read_cloud(file);
    if (!cloud) return failed(cloud.error());
    const auto stamp = kPeriod * static_cast<std::uint64_t>(path.size());
    odometry.advance(kFirst + stamp);
    const perception::OdometryState& state =
        odometry.update(*cloud, {}, false);  // Their points have no times.
    path.push_back({1e-9 * static_cast<double>(stamp), state.pose});
  }
  if (const auto written = sim::write_tum(argv[2], path); !written) return failed(written.error());
  const Eigen::Vector3d end = path.back().pose.position;
  std::printf("%zu clouds, the last one at (%.2f, %.2f, %.2f)\n", path.size(), end.x(), end.y(), end.z());
}
