// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <nlohmann/json.hpp>

#include "core/config/sensors_file.hpp"
#include "perception/map/export/map_file.hpp"
#include "perception/map/submap_grid.hpp"
#include "perception/map/voxel_image.hpp"
#include "sim/cloud/cloud_file.hpp"
#include "sim/cloud/tum_file.hpp"
#include "sim/navtool/cpu_time.hpp"
#include "sim/perctool/commands.hpp"
#include "sim/perctool/medians.hpp"
#include "sim/rehearsal/program/report_error.hpp"

namespace adit::sim::perctool {

int map(const MapOptions& options) {
  const auto files = cloud_files(options.clouds);
  if (!files) return report_error("perctool", files.error());
  const auto poses = read_tum(options.poses);
  if (!poses) return report_error("perctool", poses.error());
  if (poses->size() != files->size())
    return report_error("perctool", Error{Reason::syntax, options.poses + ": one pose a cloud is expected"});
  Pose3 T_base_lidar;
  if (!options.sensor.empty()) {
    auto sensors = config::load_sensors_file(options.sensor);
    if (!sensors) return report_error("perctool", sensors.error());
    T_base_lidar = sensors->lidars.front().mounting.pose();
  }
  perception::SubmapGrid grid(options.resolution);
  Medians times;
  for (std::size_t n = 0; n < files->size(); ++n) {
    const auto cloud = read_cloud((*files)[n]);
    if (!cloud) return report_error("perctool", cloud.error());
    const double begin = navtool::cpu_ms();
    const Eigen::Affine3f T_map_lidar = [&] {
      const Pose3 pose = (*poses)[n].pose * T_base_lidar;
      return Eigen::Affine3f(Eigen::Translation3f(pose.position.cast<float>()) *
                             pose.orientation.cast<float>());
    }();
    PointCloud points;
    points.reserve(cloud->size());
    for (const Eigen::Vector3f& p : *cloud) points.push_back(T_map_lidar * p);
    grid.insert(T_map_lidar.translation(), points, static_cast<float>(options.range));
    const double ms = navtool::cpu_ms() - begin;
    times.add(ms);
    if (options.json)
      std::printf("%s\n",
                  nlohmann::ordered_json{{"sweep", n}, {"ms", ms}, {"points", points.size()}}.dump().c_str());
  }
  perception::VoxelImage image(options.resolution);
  image.add(Pose3{}, grid);
  if (const auto saved = perception::save_map(image, options.out); !saved)
    return report_error("perctool", saved.error());
  if (options.json) {
    const nlohmann::ordered_json last{{"sweeps", files->size()},        {"ms_median", times.median()},
                                      {"ms_p99", times.quantile(0.99)}, {"occupied", image.occupied_count()},
                                      {"free", image.free_count()},     {"bytes", grid.bytes()}};
    std::printf("%s\n", last.dump().c_str());
  } else {
    std::printf("%zu clouds, %.2f ms each, %zu voxels occupied and %zu free, %.1f MB\n", files->size(),
                times.median(), image.occupied_count(), image.free_count(),
                1e-6 * static_cast<double>(grid.bytes()));
  }
  return 0;
}

}  // namespace adit::sim::perctool
