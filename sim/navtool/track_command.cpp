// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/config/platform_file.hpp"
#include "nav/control/controller.hpp"
#include "sim/navtool/canvas.hpp"
#include "sim/navtool/commands.hpp"
#include "sim/navtool/cpu_time.hpp"
#include "sim/rehearsal/program/report_error.hpp"

namespace adit::sim::navtool {
namespace {

using Points = std::vector<Eigen::Vector2d>;
constexpr double kStep = 0.05;         // m: between points of the path
constexpr double kTrackPeriod = 0.05;  // s
constexpr double kLongest = 300.0;     // s
constexpr double kBehind = 0.3;        // m: of the path that is given behind the robot

/// Points at equal distances along a line.
Points dense(const Points& corners) {
  Points all;
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
    const Eigen::Vector2d way = corners[i + 1] - corners[i];
    const int parts = std::max(1, static_cast<int>(std::ceil(way.norm() / kStep)));
    for (int k = 0; k < parts; ++k) all.push_back(corners[i] + way * k / parts);
  }
  all.push_back(corners.back());
  return all;
}

Points wave() {
  Points points;
  for (double x = 0; x <= 8.0; x += kStep) points.emplace_back(x, 0.8 * std::sin(0.9 * x));
  // Then a corner of 0.8 m radius.
  const Eigen::Vector2d end = points.back(), way = (end - points[points.size() - 2]).normalized();
  const Eigen::Vector2d centre = end + 0.8 * Eigen::Vector2d(-way.y(), way.x());
  for (double turn = 0.05; turn < M_PI / 2; turn += 0.05)
    points.push_back(centre + Eigen::Rotation2Dd(turn) * (end - centre));
  points.push_back(points.back() + 2.0 * (points.back() - points[points.size() - 2]).normalized());
  return dense(points);
}

Result<Points> read_path(const std::string& file) {
  std::ifstream stream(file);
  if (!stream) return {Reason::cannot_read, file + ": cannot be read"};
  Points points;
  std::string line;
  for (int n = 1; std::getline(stream, line); ++n) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream words(line);
    double x = 0, y = 0;
    std::string rest;
    if (!(words >> x >> y) || (words >> rest) || std::abs(x) > 1e4 || std::abs(y) > 1e4 ||
        points.size() > 10'000)
      return {Reason::syntax, file + ":" + std::to_string(n) + ": x y expected, m, at most 10000 lines"};
    points.emplace_back(x, y);
  }
  if (points.size() < 2) return {Reason::syntax, file + ": a path has two points at least"};
  return dense(points);
}

/// The path's direction at a point of it, rad: over some points, since a line of corners bends all at once.
double heading(const Points& path, std::size_t i) {
  constexpr std::size_t kAround = 3;
  const Eigen::Vector2d way =
      path[std::min(i + kAround, path.size() - 1)] - path[i > kAround ? i - kAround : 0];
  return std::atan2(way.y(), way.x());
}

/// The part of the path that begins at an index, as a plan. `ahead`: of base_link before what follows the
/// path, m.
nav::Plan plan_from(const Points& path, std::size_t begin, double speed, double ahead) {
  nav::Plan plan;
  plan.max_speed = speed;
  plan.clearance = 2.0;
  for (std::size_t i = begin; i < path.size() && plan.pose_count < nav::Plan::kMaxPath; ++i) {
    plan.poses[plan.pose_count++] = Pose2{path[i].x(), path[i].y(), heading(path, i)} * Pose2{ahead, 0, 0};
    if (plan.pose_count > 1) plan.length += (path[i] - path[i - 1]).norm();
  }
  plan.ends_at_goal = begin + plan.pose_count >= path.size();
  return plan;
}

struct Run {
  double rms{0}, worst{0}, seconds{0}, ms{0};
  bool arrived{false};
  Points driven{};
};

Run drive(nav::Controller& controller, const Platform& platform, const Points& path) {
  Run run;
  // Of what follows the path and is turned about: a car's rear axle, of others base_link.
  Pose2 pose{path[0].x(), path[0].y(), heading(path, 0)};
  const double ahead = platform.rear_axle();
  std::size_t nearest = 0;
  double sum = 0;
  int samples = 0;
  const double begin = cpu_ms();
  while (run.seconds < kLongest) {
    const std::size_t last = std::min(path.size(), nearest + 20);
    for (std::size_t i = nearest; i < last; ++i)
      if ((path[i] - pose.position()).norm() < (path[nearest] - pose.position()).norm()) nearest = i;
    const auto behind = static_cast<std::size_t>(kBehind / kStep);
    controller.set_plan(plan_from(path, std::min(nearest > behind ? nearest - behind : 0, path.size() - 2),
                                  platform.max_speed, ahead));
    const Twist2 v = controller.follow(pose * Pose2{ahead, 0, 0}, kTrackPeriod);
    for (int k = 0; k < 5; ++k)
      pose = pose * Pose2{v.vx * kTrackPeriod / 5, v.vy * kTrackPeriod / 5, v.wz * kTrackPeriod / 5};
    run.seconds += kTrackPeriod;
    run.driven.push_back(pose.position());
    double error = 1e9;  // to the line, not to its points
    for (std::size_t i = nearest > 5 ? nearest - 5 : 0; i + 1 < std::min(path.size(), nearest + 20); ++i) {
      const Eigen::Vector2d way = path[i + 1] - path[i];
      const double t = std::clamp((pose.position() - path[i]).dot(way) / way.squaredNorm(), 0.0, 1.0);
      error = std::min(error, (path[i] + t * way - pose.position()).norm());
    }
    sum += error * error;
    ++samples;
    run.worst = std::max(run.worst, error);
    run.arrived = (path.back() - pose.position()).norm() < 0.25;
    if (run.arrived) break;
  }
  run.ms = (cpu_ms() - begin) / std::max(1, samples);
  run.rms = std::sqrt(sum / std::max(1, samples));
  return run;
}

}  // namespace

int track(const TrackOptions& options) {
  const auto platform = config::load_platform(options.platform);
  if (!platform) return report_error("navtool", platform.error());
  const auto path = options.path.empty() ? Result<Points>(wave()) : read_path(options.path);
  if (!path) return report_error("navtool", path.error());
  constexpr std::array tones{Colour{0.0, 0.45, 0.7}, Colour{0.84, 0.37, 0.0}, Colour{0.0, 0.62, 0.45}};
  std::vector<Run> runs;
  bool all = true;
  for (const std::string& name : nav::controller_names()) {
    const auto controller = nav::make_controller(name, *platform);
    if (!controller) return report_error("navtool", controller.error());
    runs.push_back(drive(**controller, *platform, *path));
    const Run& run = runs.back();
    all &= run.arrived;
    if (options.json)
      std::printf("%s\n", nlohmann::ordered_json{{"controller", name},
                                                 {"rms_m", run.rms},
                                                 {"max_m", run.worst},
                                                 {"seconds", run.seconds},
                                                 {"arrived", run.arrived},
                                                 {"cycle_ms", run.ms}}
                              .dump()
                              .c_str());
    else
      std::printf("%-14s error %.3f m rms, %.3f m at most; %.1f s%s; %.3f ms a cycle\n", name.c_str(),
                  run.rms, run.worst, run.seconds, run.arrived ? "" : ", did not arrive", run.ms);
  }
  if (!options.picture.empty()) {
    Eigen::Vector2d low = path->front(), high = path->front();
    for (const auto& p : *path) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    Canvas canvas(low - Eigen::Vector2d(1, 1), high + Eigen::Vector2d(1, 1),
                  "Tracking with " + platform->name);
    canvas.line(*path, 6, {0.8, 0.8, 0.78});
    for (std::size_t i = 0; i < runs.size(); ++i) {
      canvas.line(runs[i].driven, 2, tones[i % tones.size()]);
      canvas.legend(nav::controller_names()[i], tones[i % tones.size()]);
    }
    if (const auto drawn = canvas.save(options.picture); !drawn)
      return report_error("navtool", drawn.error());
  }
  return all ? 0 : 1;
}

}  // namespace adit::sim::navtool
