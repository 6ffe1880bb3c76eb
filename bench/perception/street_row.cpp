// SPDX-License-Identifier: Apache-2.0
#include "bench/perception/street_row.hpp"

#include <algorithm>
#include <cstdio>

#include "bench/nav/calibration.hpp"
#include "perception/odometry/lidar_odometry.hpp"
#include "sim/cloud/cloud_file.hpp"
#include "sim/cloud/tum_file.hpp"

namespace adit::bench {
namespace {

constexpr std::size_t kOver = 10;  ///< Clouds.

struct NamedPath {
  std::string name{};
  std::vector<Pose3> poses{};
};

double median_of(std::vector<double> values) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

void print_difference(const NamedPath& a, const NamedPath& b) {
  std::vector<double> mm, degrees;
  for (std::size_t n = 0; n + kOver < std::min(a.poses.size(), b.poses.size()); ++n) {
    const Pose3 by_a = a.poses[n].inverse() * a.poses[n + kOver],
                by_b = b.poses[n].inverse() * b.poses[n + kOver];
    mm.push_back(1e3 * (by_a.position - by_b.position).norm());
    degrees.push_back(by_a.orientation.angularDistance(by_b.orientation) * 180 / M_PI);
  }
  std::printf(
      "street     %s and %s differ by %.0f mm and %.3f degrees over ten sweeps (must 37 mm from each)\n",
      a.name.c_str(), b.name.c_str(), median_of(mm), median_of(degrees));
}

Result<NamedPath> run_street(const std::string& clouds) {
  const auto files = sim::cloud_files(clouds);
  if (!files) return files.error();
  const LidarConfig lidar;
  perception::LidarOdometry odometry(
      perception::LidarOdometryParams::clouds_only(lidar.noise, lidar.min_range, lidar.max_range));
  NamedPath path{"adit", {}};
  std::vector<double> ms;
  for (const auto& file : *files) {
    const auto cloud = sim::read_cloud(file);
    if (!cloud) return cloud.error();
    const double begin = thread_cpu_ms();
    odometry.advance(1'000'000'000 + 100'000'000 * static_cast<std::uint64_t>(path.poses.size()));
    path.poses.push_back(odometry.update(*cloud, {}, false).pose);
    ms.push_back(thread_cpu_ms() - begin);
  }
  const double median = median_of(ms);
  std::printf("street     %zu sweeps, median %.2f ms (%.2f units, must 7)\n", ms.size(), median,
              median / calibration_unit_ms());
  return path;
}

}  // namespace

Result<void> print_street(const std::string& clouds, const std::vector<std::string>& peers) {
  const auto ours = run_street(clouds);
  if (!ours) return ours.error();
  std::vector<NamedPath> all{*ours};
  for (const std::string& peer : peers) {
    const std::size_t split = peer.find('=');
    if (split == std::string::npos || split == 0)
      return {Reason::bad_argument, "--peer " + peer + ": expected NAME=FILE.tum"};
    const auto poses = sim::read_tum(peer.substr(split + 1));
    if (!poses) return poses.error();
    NamedPath path{peer.substr(0, split), {}};
    for (const sim::StampedPose& each : *poses) path.poses.push_back(each.pose);
    for (const NamedPath& other : all) print_difference(other, path);
    all.push_back(std::move(path));
  }
  return {};
}

}  // namespace adit::bench
