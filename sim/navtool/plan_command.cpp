// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "core/config/platform_file.hpp"
#include "nav/local_navigation.hpp"
#include "sim/cloud/cloud_file.hpp"
#include "sim/navtool/canvas.hpp"
#include "sim/navtool/commands.hpp"
#include "sim/navtool/cpu_time.hpp"
#include "sim/rehearsal/program/report_error.hpp"

namespace adit::sim::navtool {
namespace {

constexpr double kNear = 6.0;  // m: where the ground is looked for

/// How far the lowest points around the sensor are from where the ground must be, m; a point of the cloud by
/// `in_sensor` is in the sensor's frame.
template <class Convert>
double ground_error(const CloudFile& cloud, double lidar_height, const Convert& in_sensor) {
  std::vector<double> heights;
  for (const perception::TimedPoint& point : cloud.sweep.points) {
    const Eigen::Vector3f& p = point.position;
    if (!p.allFinite()) continue;
    const Eigen::Vector3d q = in_sensor(p.cast<double>());
    if (q.head<2>().norm() < kNear) heights.push_back((cloud.viewpoint.orientation * q).z());
  }
  if (heights.size() < 10) return 1e9;
  const auto low = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 10);
  std::nth_element(heights.begin(), low, heights.end());
  return std::abs(*low + lidar_height);
}

/// Whether the points are in the map's frame: the ground then lies where the lidar's height says.
bool in_map_frame(const PlanOptions& options, const CloudFile& cloud, double lidar_height) {
  if (options.frame != "auto") return options.frame == "map";
  const Pose3 to_sensor = cloud.viewpoint.inverse();
  return ground_error(cloud, lidar_height, [&](const Eigen::Vector3d& p) { return to_sensor * p; }) <=
         ground_error(cloud, lidar_height, [](const Eigen::Vector3d& p) { return p; });
}

void print(const PlanOptions& options, std::size_t cycle, double terrain_ms, double plan_ms,
           const nav::Plan& plan) {
  if (!options.json) {
    std::printf("cycle %zu: terrain %.3f ms, plan %.3f ms, ", cycle, terrain_ms, plan_ms);
    if (plan.blocked || plan.arrived)
      std::puts(plan.blocked ? "blocked" : "arrived");
    else
      std::printf("path of %.2f m\n", plan.length);
    return;
  }
  nlohmann::ordered_json line{
      {"cycle", cycle}, {"terrain_ms", terrain_ms}, {"plan_ms", plan_ms}, {"blocked", plan.blocked}};
  nlohmann::json path = nlohmann::json::array();
  for (const Pose2& p : plan.path()) path.push_back({p.x, p.y});
  line["path"] = std::move(path);
  std::printf("%s\n", line.dump().c_str());
}

/// The places of the local map, paler where they cost less.
void draw_places(Canvas& canvas, std::span<const nav::LocalPlace> places, const Eigen::Vector2d& at) {
  struct Look {
    nav::CellClass kind;
    Colour colour;
    double pixels;
  };
  // Movers and obstacles last: they are the smallest.
  static const std::array<Look, 5> looks{{{nav::CellClass::step, {0.80, 0.70, 0.10}, 8.0},
                                          {nav::CellClass::slope, {0.93, 0.55, 0.10}, 8.0},
                                          {nav::CellClass::drop, {0.45, 0.15, 0.60}, 5.0},
                                          {nav::CellClass::obstacle, {0.75, 0.10, 0.12}, 2.5},
                                          {nav::CellClass::mover, {0.10, 0.35, 0.75}, 2.5}}};
  for (const Look& look : looks) {
    for (const nav::LocalPlace& place : places) {
      const Eigen::Vector2d q(place.x, place.y);
      if (place.kind != look.kind || (q - at).cwiseAbs().maxCoeff() >= 5.0) continue;
      const double share = 0.25 + 0.75 * static_cast<double>(place.cost);
      const auto pale = [share](double c) { return 0.98 + share * (c - 0.98); };
      canvas.dot(q, look.pixels, {pale(look.colour.r), pale(look.colour.g), pale(look.colour.b)});
    }
    canvas.legend(nav::kCellClassNames[static_cast<std::size_t>(look.kind)], look.colour);
  }
}

Result<void> draw(const PlanOptions& options, const Platform& platform, const nav::Plan& plan,
                  std::span<const nav::LocalPlace> places, const CloudFile& cloud, const Pose3& to_map,
                  const Pose3& body) {
  const Eigen::Vector2d at = body.position.head<2>();
  Canvas canvas(at - Eigen::Vector2d(6, 5), at + Eigen::Vector2d(6, 5), "Local plan: " + options.clouds);
  constexpr Colour points{0.6, 0.64, 0.68}, path{0.0, 0.45, 0.7}, goal{0.84, 0.37, 0.0};
  for (const Eigen::Vector3f& p : points_of(cloud.sweep)) {
    if (!p.allFinite()) continue;
    const Eigen::Vector2d q = (to_map * p.cast<double>()).head<2>();
    if ((q - at).cwiseAbs().maxCoeff() < 5.0) canvas.dot(q, 1.0, points);
  }
  draw_places(canvas, places, at);
  std::vector<Eigen::Vector2d> line;
  for (const Pose2& p : plan.path()) line.push_back(p.position());
  canvas.line(line, 4, path);
  canvas.body(platform, body.planar(), {0.13, 0.15, 0.19});
  if ((options.goal - at).cwiseAbs().maxCoeff() < 5.0) canvas.dot(options.goal, 8, goal);
  canvas.legend("points", points);
  canvas.legend(plan.blocked ? "blocked" : "path", path);
  canvas.legend("goal", goal);
  return canvas.save(options.picture);
}

}  // namespace

int plan(const PlanOptions& options) {
  const auto platform = config::load_platform(options.platform);
  if (!platform) return report_error("navtool", platform.error());
  const auto files = cloud_files(options.clouds);
  if (!files) return report_error("navtool", files.error());
  nav::LocalNavigation local_navigation(*platform);
  const Pose3 sensor_in_body{platform->lidar_origin(), Eigen::Quaterniond::Identity()};
  bool registered = false;
  for (std::size_t cycle = 0; cycle < files->size(); ++cycle) {
    const auto cloud = read_cloud_file((*files)[cycle]);
    if (!cloud) return report_error("navtool", cloud.error());
    if (cycle == 0) registered = in_map_frame(options, *cloud, platform->lidar_height);
    const Pose3 body = cloud->viewpoint * sensor_in_body.inverse();
    const Pose3 to_body = registered ? body.inverse() : sensor_in_body;
    PointCloud points;
    points.reserve(cloud->sweep.points.size());
    for (const Eigen::Vector3f& p : points_of(cloud->sweep))
      if (p.allFinite()) points.push_back((to_body * p.cast<double>()).cast<float>());
    const double stamp = kCloudPeriod * static_cast<double>(cycle);
    const double t0 = cpu_ms();
    local_navigation.add_scan(points, body, stamp);
    const double t1 = cpu_ms();
    const nav::Plan plan = local_navigation.plan(nav::Target::to(options.goal), body.planar(), stamp);
    print(options, cycle, t1 - t0, cpu_ms() - t1, plan);
    if (!options.picture.empty() && cycle + 1 == files->size())
      if (const auto drawn = draw(options, *platform, plan, local_navigation.map()->places(), *cloud,
                                  registered ? Pose3{} : cloud->viewpoint, body);
          !drawn)
        return report_error("navtool", drawn.error());
  }
  return 0;
}

}  // namespace adit::sim::navtool
