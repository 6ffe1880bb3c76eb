#include "sim/world/lidar.hpp"

#include <algorithm>
#include <cmath>

#include "sim/world/noise.hpp"

namespace adit::sim {
namespace {

/// A box in its own frame, with the sensor's position there.
struct Target {
  Eigen::Vector2d axis;     ///< cos, sin of its yaw in the world
  Eigen::Vector3d start;    ///< of the beams, box frame
  Eigen::Vector3d half;     ///< half its edges, m
  Eigen::Vector2d towards;  ///< unit vector from the sensor, world
  double cos_spread;        ///< cosine of the half angle that the box fills, seen from above
};

Target make_target(const BodyBox& body, const Eigen::Vector3d& sensor) {
  Target target{};
  target.axis = {std::cos(body.pose.yaw), std::sin(body.pose.yaw)};
  const Eigen::Vector2d away(sensor.x() - body.pose.x, sensor.y() - body.pose.y);
  target.half = 0.5 * Eigen::Vector3d(body.length, body.width, body.height);
  target.start = {target.axis.dot(away), target.axis.x() * away.y() - target.axis.y() * away.x(),
                  sensor.z() - body.ground - target.half.z()};
  const double distance = away.norm(), radius = target.half.head<2>().norm();
  target.cos_spread = distance > radius ? std::sqrt(1.0 - radius * radius / (distance * distance)) : -1.0;
  target.towards = distance > 0.0 ? Eigen::Vector2d(-away / distance) : Eigen::Vector2d(1.0, 0.0);
  return target;
}

/// Distance to the box by slabs (Kay and Kajiya, 1986); no_hit when missed or when the beam starts inside.
double cast_box(const Target& target, const Eigen::Vector3d& direction) {
  const Eigen::Vector3d d(target.axis.x() * direction.x() + target.axis.y() * direction.y(),
                          target.axis.x() * direction.y() - target.axis.y() * direction.x(), direction.z());
  double enter = 0.0, leave = VoxelGrid::no_hit;
  for (int n = 0; n < 3; ++n) {
    if (d[n] == 0.0) {
      if (std::abs(target.start[n]) > target.half[n]) return VoxelGrid::no_hit;
      continue;
    }
    const double a = (-target.half[n] - target.start[n]) / d[n],
                 b = (target.half[n] - target.start[n]) / d[n];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter > 0.0 && enter <= leave ? enter : VoxelGrid::no_hit;
}

Eigen::Vector2d unit(double angle) { return {std::cos(angle), std::sin(angle)}; }

}  // namespace

LidarParams LidarParams::planar() {
  LidarParams params;
  params.rings = 1;
  params.columns = 360;
  params.profile = true;
  return params;
}

LidarPattern::LidarPattern(const LidarParams& params) : params_(params) {
  for (int n = 0; n < params.columns; ++n) azimuth_.push_back(unit(2.0 * M_PI * n / params.columns));
  for (int n = 0; n < params.rings; ++n) {
    const double step = params.rings > 1 ? (params.highest - params.lowest) / (params.rings - 1) : 0.0;
    elevation_.push_back(unit(params.rings > 1 ? (params.lowest + n * step) * M_PI / 180.0 : 0.0));
  }
}

PointCloud LidarPattern::scan(const World& world, std::span<const BodyBox> others, const Pose3& base,
                              double height, std::uint64_t seed) const {
  const Eigen::Matrix3d rotation = base.orientation.toRotationMatrix();
  const VoxelGrid::Start start = world.grid().locate(base.position + height * rotation.col(2));
  std::vector<Target> targets;
  for (const BodyBox& body : others) targets.push_back(make_target(body, start.position));
  const bool level = rotation.col(2) == Eigen::Vector3d::UnitZ();
  Random random(seed);
  PointCloud points;
  points.reserve(size());
  std::vector<Eigen::Vector3d> directions(elevation_.size());
  std::vector<double> ranges(elevation_.size());
  for (const Eigen::Vector2d& azimuth : azimuth_) {
    const Eigen::Vector3d ahead = rotation.col(0) * azimuth.x() + rotation.col(1) * azimuth.y();
    for (std::size_t n = 0; n < elevation_.size(); ++n)
      directions[n] = ahead * elevation_[n].x() + rotation.col(2) * elevation_[n].y();
    world.grid().cast(start, directions, params_.max_range, ranges);
    for (const Target& target : targets)
      if (!level || ahead.head<2>().dot(target.towards) >= target.cos_spread)
        for (std::size_t n = 0; n < elevation_.size(); ++n)
          ranges[n] = std::min(ranges[n], cast_box(target, directions[n]));
    for (std::size_t n = 0; n < elevation_.size(); ++n) {
      const Eigen::Vector2d& elevation = elevation_[n];
      // Drawn for every beam, so that a robot in the way of some leaves the noise of the others alone.
      const double range = ranges[n] + params_.range_noise * gaussian(random);
      if (!(range >= params_.min_range && range <= params_.max_range)) continue;
      const double flat = range * elevation.x();
      points.emplace_back(static_cast<float>(flat * azimuth.x()), static_cast<float>(flat * azimuth.y()),
                          static_cast<float>(height + range * elevation.y()));
    }
  }
  return points;
}

}  // namespace adit::sim
