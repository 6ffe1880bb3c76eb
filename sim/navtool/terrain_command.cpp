// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "core/config/platform_file.hpp"
#include "core/config/sensors_file.hpp"
#include "sim/cloud/cloud_file.hpp"
#include "sim/cloud/tum_file.hpp"
#include "sim/navtool/canvas.hpp"
#include "sim/navtool/commands.hpp"
#include "sim/navtool/cpu_time.hpp"
#include "sim/navtool/terrain_survey.hpp"
#include "sim/rehearsal/program/report_error.hpp"

namespace adit::sim::navtool {
namespace {

constexpr std::array kOrder{nav::CellClass::ground,   nav::CellClass::step, nav::CellClass::slope,
                            nav::CellClass::obstacle, nav::CellClass::drop, nav::CellClass::unknown};

void print(const TerrainOptions& options, const TerrainSurvey& survey, std::size_t clouds, double ms) {
  const TerrainCounts counts = survey.counts();
  nlohmann::ordered_json cells, m2;
  for (const nav::CellClass kind : kOrder) {
    const auto n = static_cast<std::size_t>(kind);
    cells[nav::kCellClassNames[n]] = counts[n];
    m2[nav::kCellClassNames[n]] =
        static_cast<double>(counts[n]) * TerrainSurvey::kCell * TerrainSurvey::kCell;
  }
  const double each = ms / static_cast<double>(clouds);
  if (options.json) {
    const nlohmann::ordered_json out{{"m2", m2},
                                     {"cells", cells},
                                     {"drop_share", TerrainSurvey::drop_share(counts)},
                                     {"unknown_share", survey.unknown_share()},
                                     {"range", options.range},
                                     {"clouds", clouds},
                                     {"terrain_ms", each}};
    std::printf("%s\n", out.dump().c_str());
    return;
  }
  std::printf("%zu clouds within %.1f m, %.2f ms each:", clouds, options.range, each);
  for (const nav::CellClass kind : kOrder) {
    const char* name = nav::kCellClassNames[static_cast<std::size_t>(kind)];
    std::printf(" %s %.1f m2,", name, m2[name].get<double>());
  }
  std::printf(" drops %.2g of ground\n", TerrainSurvey::drop_share(counts));
}

Result<void> draw(const TerrainOptions& options, const TerrainSurvey& survey, const Platform& platform,
                  const std::vector<Pose2>& trail) {
  Eigen::AlignedBox2d box;
  for (const Pose2& pose : trail) box.extend(pose.position());
  const Eigen::Vector2d margin = Eigen::Vector2d::Constant(options.range + 0.5);
  Canvas canvas(box.min() - margin, box.max() + margin, "Terrain: " + options.cloud);
  // By class; a survey knows no movers.
  static constexpr std::array<Colour, nav::kCellClasses> colours{{{0.90, 0.90, 0.89},
                                                                  {0.62, 0.80, 0.60},
                                                                  {0.93, 0.55, 0.10},
                                                                  {0.80, 0.70, 0.10},
                                                                  {0.75, 0.10, 0.12},
                                                                  {0.45, 0.15, 0.60}}};
  const double pixels =
      std::clamp(1160.0 / (2 * margin.x() + box.sizes().x()) * TerrainSurvey::kCell, 1.0, 12.0);
  survey.for_each([&](const Eigen::Vector2d& at, nav::CellClass kind) {
    canvas.dot(at, 0.5 * pixels, colours[static_cast<std::size_t>(kind)]);
  });
  canvas.body(platform, trail.back(), {0.13, 0.15, 0.19});
  for (const nav::CellClass kind : kOrder) {
    const auto n = static_cast<std::size_t>(kind);
    canvas.legend(nav::kCellClassNames[n], colours[n]);
  }
  return canvas.save(options.picture);
}

}  // namespace

int terrain(const TerrainOptions& options) {
  auto platform = config::load_platform(options.platform);
  if (!platform) return report_error("navtool", platform.error());
  if (!options.sensor.empty()) {
    auto sensors = config::load_sensors_file(options.sensor);
    if (!sensors) return report_error("navtool", sensors.error());
    platform->lidars = std::move(sensors->lidars);
    platform->lidar_height = platform->lidar().mounting.z;
  }
  const Pose3 lidar = platform->lidar().mounting.pose();
  const auto files = cloud_files(options.cloud);
  if (!files) return report_error("navtool", files.error());
  std::vector<StampedPose> poses;
  if (!options.poses.empty()) {
    auto read = read_tum(options.poses);
    if (!read) return report_error("navtool", read.error());
    poses = std::move(*read);
    if (poses.size() != files->size())
      return report_error("navtool", Error{Reason::syntax, options.poses + ": one pose a cloud is expected"});
  }
  TerrainSurvey survey(*platform, options.range);
  std::vector<Pose2> trail;
  double ms = 0.0;
  for (std::size_t n = 0; n < files->size(); ++n) {
    auto cloud = read_cloud((*files)[n]);
    if (!cloud) return report_error("navtool", cloud.error());
    for (Eigen::Vector3f& p : *cloud) p = (lidar * p.cast<double>()).cast<float>();
    const Pose3 body = poses.empty() ? Pose3{} : poses[n].pose;
    const double begin = cpu_ms();
    survey.add_scan(*cloud, body, kCloudPeriod * static_cast<double>(n));
    ms += cpu_ms() - begin;
    trail.push_back(body.planar());
  }
  print(options, survey, files->size(), ms);
  if (!options.picture.empty())
    if (const auto drawn = draw(options, survey, *platform, trail); !drawn)
      return report_error("navtool", drawn.error());
  return 0;
}

}  // namespace adit::sim::navtool
