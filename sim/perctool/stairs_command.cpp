// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "core/config/sensors_file.hpp"
#include "core/findings/merge_stairs.hpp"
#include "perception/stairs/stairs_detector.hpp"
#include "robot_agent/stairs/stairs_tracker.hpp"
#include "sim/cloud/cloud_file.hpp"
#include "sim/cloud/tum_file.hpp"
#include "sim/perctool/commands.hpp"
#include "sim/rehearsal/program/report_error.hpp"

namespace adit::sim::perctool {
namespace {

using Triple = std::array<double, 3>;

Triple triple(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

void print(const Staircase& s, bool as_json, const std::string& cloud) {
  if (!as_json) {
    std::printf(
        "%d steps of %.3f m by %.3f m, %.2f m wide, from (%.2f, %.2f, %.2f) to (%.2f, %.2f, %.2f), %.0f "
        "degrees\n",
        s.steps, s.rise, s.run, s.width, s.foot.x(), s.foot.y(), s.foot.z(), s.top().x(), s.top().y(),
        s.top().z(), s.heading * 180.0 / M_PI);
    return;
  }
  nlohmann::ordered_json out{{"foot", triple(s.foot)}, {"top", triple(s.top())}, {"heading", s.heading},
                             {"steps", s.steps},       {"rise", s.rise},         {"run", s.run},
                             {"width", s.width}};
  out["sigmas"] = {{"place", s.sigma.place},
                   {"heading", s.sigma.heading},
                   {"rise", s.sigma.rise},
                   {"run", s.sigma.run},
                   {"width", s.sigma.width}};
  if (!cloud.empty()) out["cloud"] = cloud;
  std::printf("%s\n", out.dump().c_str());
}

/// As a lidar sees them, and then those that only points of many places show.
std::vector<Staircase> stairs_in(perception::StairsDetector& detector, const PointCloud& points,
                                 const Eigen::Vector3f& eye) {
  std::vector<Staircase> found = detector.detect(points, eye);
  for (const Staircase& other : detector.detect(points, eye, false))
    if (std::none_of(found.begin(), found.end(),
                     [&](const Staircase& one) { return findings::is_same_flight(one, other); }))
      found.push_back(other);
  return found;
}

}  // namespace

int stairs(const StairsOptions& options) {
  const auto files = cloud_files(options.clouds);
  if (!files) return report_error("perctool", files.error());
  std::vector<StampedPose> poses;
  if (!options.poses.empty()) {
    auto read = read_tum(options.poses);
    if (!read) return report_error("perctool", read.error());
    if (read->size() != files->size())
      return report_error("perctool",
                          Error{Reason::syntax, options.poses + ": one pose a cloud is expected"});
    poses = std::move(*read);
  }
  Eigen::Vector3f eye(0.0f, 0.0f, static_cast<float>(options.eye));
  if (!options.sensor.empty()) {
    auto sensors = config::load_sensors_file(options.sensor);
    if (!sensors) return report_error("perctool", sensors.error());
    eye = sensors->lidars.front().mounting.pose().position.cast<float>();
  }
  perception::StairsDetector detector;
  agent::StairsTracker tracker;
  std::vector<std::size_t> sizes;
  PointCloud window;
  for (std::size_t n = 0; n < files->size(); ++n) {
    auto cloud = read_cloud((*files)[n]);
    if (!cloud) return report_error("perctool", cloud.error());
    if (poses.empty()) {
      for (const Staircase& s : stairs_in(detector, *cloud, eye))
        print(s, options.json, files->size() > 1 ? (*files)[n].filename().string() : "");
      continue;
    }
    const Pose3& pose = poses[n].pose;
    const Eigen::Affine3f T =
        Eigen::Translation3f(pose.position.cast<float>()) * pose.orientation.cast<float>();
    for (const Eigen::Vector3f& p : *cloud) window.push_back(T * p);
    sizes.push_back(cloud->size());
    constexpr std::size_t most = 15;  // 1.5 s at 10 Hz.
    if (sizes.size() > most) {
      window.erase(window.begin(), window.begin() + static_cast<std::ptrdiff_t>(sizes.front()));
      sizes.erase(sizes.begin());
    }
    tracker.take(stairs_in(detector, window, T * eye), pose.position);
  }
  for (const auto& tracked : tracker.confirmed()) print(tracked.stairs, options.json, "");
  return 0;
}

}  // namespace adit::sim::perctool
