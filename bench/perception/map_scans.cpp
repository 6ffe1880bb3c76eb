// SPDX-License-Identifier: Apache-2.0
#include "bench/perception/map_scans.hpp"

#include <array>

#include "tests/folders/folders.hpp"

namespace adit::bench {
namespace {

constexpr double kHeight = 0.5;  ///< Of the lidar above the ground, m.

std::vector<MapScan> carry(const sim::World& world, const sim::LidarParams& params, int scans, double y) {
  const sim::LidarPattern lidar(params);
  std::vector<MapScan> out;
  for (int n = 0; n < scans; ++n) {
    // The height of the lidar differs from scan to scan, as rays along the voxels' layers would flatter.
    const Pose3 base = Pose3::level({4.0 + 0.2 * n, y, 0.05 * n}, 0.03 + 0.002 * (n % 7));
    PointCloud points = lidar.scan(world, {}, base, kHeight, static_cast<std::uint64_t>(n) + 1);
    for (Eigen::Vector3f& p : points) p = (base * p.cast<double>()).cast<float>();
    out.push_back({(base * Eigen::Vector3d(0, 0, kHeight)).cast<float>(), std::move(points)});
  }
  return out;
}

}  // namespace

Result<std::vector<MapScan>> building_scans(const sim::LidarParams& lidar, int scans) {
  const std::array<std::filesystem::path, 3> folders{source_folder() + "/data/maps",
                                                     source_folder() + "/config",
                                                     "/usr/share/doc/liboctomap-dev/examples/data"};
  const auto file = sim::find_map("geb079.bt", folders);
  if (!file) return file.error();
  const auto world = sim::load_octomap(*file);
  if (!world) return world.error();
  return carry(*world, lidar, scans, -0.2);
}

Result<std::vector<MapScan>> hall_scans(const sim::LidarParams& lidar, int scans) {
  std::vector<sim::Box> boxes{{-18, 18, -18, -17.8, 0, 6},
                              {-18, 18, 17.8, 18, 0, 6},
                              {-18, -17.8, -18, 18, 0, 6},
                              {17.8, 18, -18, 18, 0, 6}};
  for (int i = -2; i <= 2; ++i)
    for (int j = -2; j <= 2; ++j) boxes.push_back({6.0 * i, 6.0 * i + 0.5, 6.0 * j, 6.0 * j + 0.5, 0, 6});
  const auto world = sim::make_box_world(boxes, 0.0, 6.0);
  if (!world) return world.error();
  return carry(*world, lidar, scans, 2.3);
}

}  // namespace adit::bench
