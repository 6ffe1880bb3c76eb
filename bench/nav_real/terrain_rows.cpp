// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>

#include "bench/nav_real/rows.hpp"
#include "core/config/platform_file.hpp"
#include "core/time/random.hpp"
#include "sim/cloud/cloud_file.hpp"
#include "sim/cloud/tum_file.hpp"
#include "sim/navtool/terrain_survey.hpp"
#include "sim/world/noise.hpp"

namespace adit::bench {
namespace {

constexpr double kPeriod = 0.1;  // s: of the scans
constexpr double kGoal = 1e-3;   // drops, of passable ground

/// Level ground, then a slope, then level ground again, along x; endless along y. All of it can be driven on.
class Slope {
 public:
  explicit Slope(double degrees) : rise_(std::tan(degrees * M_PI / 180.0)) {}
  double height(double x) const { return rise_ * std::clamp(x - kBegin, 0.0, kLength); }
  /// Distance along a ray to the ground, m; infinite where it meets none.
  double cast(const Eigen::Vector3d& from, const Eigen::Vector3d& way) const {
    double best = std::numeric_limits<double>::infinity();
    const auto piece = [&](double x0, double x1, double z0, double rise) {
      const double down = way.z() - rise * way.x();
      if (std::abs(down) < 1e-12) return;
      const double t = (z0 + rise * (from.x() - x0) - from.z()) / down;
      const double x = from.x() + t * way.x();
      if (t > 1e-6 && x >= x0 - 1e-9 && x <= x1 + 1e-9) best = std::min(best, t);
    };
    piece(-1e3, kBegin, 0.0, 0.0);
    piece(kBegin, kBegin + kLength, 0.0, rise_);
    piece(kBegin + kLength, 1e3, rise_ * kLength, 0.0);
    return best;
  }
  static constexpr double kBegin = 6.0, kLength = 10.0;  // m

 private:
  double rise_;
};

/// The body as its four contact points put it onto the ground, driving along x.
Pose3 standing(const Slope& slope, const Platform& body, double x) {
  const double front = slope.height(x + body.length / 2), back = slope.height(x - body.length / 2);
  const double pitch = -std::atan2(front - back, body.length);
  return {{x, 0.0, 0.5 * (front + back)},
          Eigen::Quaterniond(Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()))};
}

/// One turn of the platform's lidar, in base_link.
PointCloud scan(const Slope& slope, const Platform& body, const Pose3& base, Random& random) {
  constexpr int kColumns = 900;
  constexpr double kNoise = 0.02, kMinRange = 0.3, kMaxRange = 30.0;  // m
  const LidarConfig lidar = body.lidar();
  const Eigen::Vector3d sensor(0.0, 0.0, body.lidar_height);
  PointCloud points;
  for (int c = 0; c < kColumns; ++c)
    for (int ring = 0; ring < lidar.rings; ++ring) {
      const double azimuth = 2.0 * M_PI * c / kColumns;
      const double elevation =
          (lidar.lowest + (lidar.highest - lidar.lowest) * ring / (lidar.rings - 1)) * M_PI / 180.0;
      const Eigen::Vector3d way(std::cos(elevation) * std::cos(azimuth),
                                std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
      const double range = slope.cast(base * sensor, base.orientation * way) + kNoise * sim::gaussian(random);
      if (range >= kMinRange && range <= kMaxRange) points.push_back((sensor + range * way).cast<float>());
    }
  return points;
}

/// A drive over a slope by a robot that takes its tilt to be `bias` less than it is.
sim::TerrainCounts drive_over(double slope_degrees, double bias_degrees, double bias_heading,
                              const Platform& body) {
  constexpr double kStep = 0.1, kTo = Slope::kBegin + Slope::kLength + 2.0;  // m
  const Slope slope(slope_degrees);
  sim::TerrainSurvey survey(body, sim::TerrainSurvey::kMaxRange);
  Random random(1);
  const Eigen::Vector3d axis(-std::sin(bias_heading), std::cos(bias_heading), 0.0);
  const Eigen::Quaterniond bias(Eigen::AngleAxisd(bias_degrees * M_PI / 180.0, axis));
  double stamp = 0.0;
  for (double x = 0.0; x < kTo; x += kStep, stamp += kPeriod) {
    const Pose3 truth = standing(slope, body, x);
    const Pose3 believed{truth.position, truth.orientation * bias};
    survey.add_scan(scan(slope, body, truth, random), believed, stamp);
  }
  return survey.scan_counts();
}

/// The lidar of the street scans, a Velodyne HDL-64E.
LidarConfig street_lidar(double height) {
  LidarConfig lidar;
  lidar.mounting.z = height;
  lidar.rings = 64;
  lidar.lowest = -24.8;
  lidar.highest = 2.0;
  return lidar;
}

void add(sim::TerrainCounts& sum, const sim::TerrainCounts& counts) {
  for (std::size_t n = 0; n < sum.size(); ++n) sum[n] += counts[n];
}

}  // namespace

Result<RowResults> tilt_row(const RowOptions& options) {
  constexpr std::array kBiases{0.0, 1.0, 2.0, 3.0};                 // degrees
  constexpr std::array kSlopes{-10.0, -5.0, -2.0, 2.0, 5.0, 10.0};  // degrees
  constexpr std::array kHeadings{0.0, M_PI / 2, M_PI, 3 * M_PI / 2};
  RowResults rows;
  double worst = 0.0;
  for (const std::string& platform : options.platforms) {
    const auto body = config::load_platform(platform, {});
    if (!body) return body.error();
    Progress progress("tilt " + platform,
                      static_cast<int>(kBiases.size() * kHeadings.size() + kSlopes.size()), options.minutes);
    std::string text;
    for (const double bias : kBiases) {
      sim::TerrainCounts counts{};
      for (const double heading : kHeadings) {
        if (!progress.next() || (bias == 0.0 && heading > 0.0)) continue;
        add(counts, drive_over(0.0, bias, heading, *body));
      }
      const double share = sim::TerrainSurvey::drop_share(counts);
      worst = std::max(worst, share);
      text += fmt::format("{}bias {:.0f}: {:.2g}", text.empty() ? "" : ", ", bias, share);
    }
    for (const double slope : kSlopes) {
      if (!progress.next()) continue;
      const double share = sim::TerrainSurvey::drop_share(drive_over(slope, 0.0, 0.0, *body));
      worst = std::max(worst, share);
      text += fmt::format(", slope {:+.0f}: {:.2g}", slope, share);
    }
    rows.push_back({"tilt " + platform, text, "", "", true});
  }
  rows.push_back(
      {"tilt", fmt::format("worst share of false drops {:.2g}", worst), "< 1e-3 each", "", worst < kGoal});
  return rows;
}

Result<RowResults> street_row(const RowOptions& options) {
  constexpr double kRange = 20.0;  // m
  constexpr double kUnknown = 0.2;
  if (options.clouds.empty())
    return RowResults{{"street", "not run: --clouds DIR names no folder", "< 1e-3, <= 20 %", "", false}};
  const auto files = sim::cloud_files(options.clouds);
  if (!files) return files.error();
  auto body = config::load_platform(options.platforms.front(), {});
  if (!body) return body.error();
  body->lidars = {street_lidar(options.lidar_height)};
  body->lidar_height = options.lidar_height;
  std::vector<sim::StampedPose> poses;
  if (!options.poses.empty()) {
    auto read = sim::read_tum(options.poses);
    if (!read) return read.error();
    poses = std::move(*read);
    if (poses.size() != files->size())
      return {Reason::bad_argument, options.poses + ": one pose a cloud is expected"};
  }
  const Eigen::Vector3f up(0, 0, static_cast<float>(options.lidar_height));
  sim::TerrainSurvey together(*body, kRange);
  sim::TerrainCounts singly{};
  double worst = 0.0;
  Progress progress("street", static_cast<int>(files->size()), options.minutes);
  for (std::size_t n = 0; n < files->size() && progress.next(); ++n) {
    auto cloud = sim::read_cloud((*files)[n]);
    if (!cloud) return cloud.error();
    for (Eigen::Vector3f& p : *cloud) p += up;
    sim::TerrainSurvey alone(*body, kRange);
    alone.add_scan(*cloud, {}, 0.0);
    const sim::TerrainCounts counts = alone.counts();
    add(singly, counts);
    worst = std::max(worst, sim::TerrainSurvey::drop_share(counts));
    if (!poses.empty()) together.add_scan(*cloud, poses[n].pose, kPeriod * static_cast<double>(n));
    if (options.each)
      fmt::print("street {}: drops {:.2g}\n", (*files)[n].filename().string(),
                 sim::TerrainSurvey::drop_share(counts));
  }
  RowResults rows;
  const double share = sim::TerrainSurvey::drop_share(singly);
  rows.push_back({"street singly", fmt::format("drops {:.2g}, worst scan {:.2g}", share, worst),
                  "drops < 1e-3", "", share < kGoal});
  if (poses.empty()) {
    rows.push_back({"street accumulated", "not run: --poses FILE.tum is missing",
                    "drops < 1e-3, unknown <= 20 %", "", false});
    return rows;
  }
  const sim::TerrainCounts counts = together.counts();
  const double drops = sim::TerrainSurvey::drop_share(counts), unknown = together.unknown_share();
  rows.push_back(
      {"street accumulated",
       fmt::format("drops {:.2g}, unknown {:.0f} % of the cells with a return ({} of {} have none)", drops,
                   100.0 * unknown, together.hidden(),
                   std::accumulate(counts.begin(), counts.end(), std::size_t{0})),
       "drops < 1e-3, unknown <= 20 %", "", drops < kGoal && unknown <= kUnknown});
  return rows;
}

}  // namespace adit::bench
