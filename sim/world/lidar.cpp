// SPDX-License-Identifier: Apache-2.0
#include "sim/world/lidar.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "sim/world/box_target.hpp"
#include "sim/world/noise.hpp"

namespace adit::sim {
namespace {

Eigen::Vector2d unit(double angle) { return {std::cos(angle), std::sin(angle)}; }

/// What one beam of a column met.
struct Beam {
  Eigen::Vector2d elevation;  ///< Cosine and sine.
  double range;               ///< True range, m; no_hit beyond the lidar's.
  double measured;            ///< Range with noise, m.
};

}  // namespace

LidarParams LidarParams::planar() {
  LidarParams params;
  // Down to where a body of 0.4 m is seen from beside it; the level one sees walls as far as the lidar does.
  params.elevations = {-25.0, -15.0, -11.0, -4.0, 0.0};
  params.rings = static_cast<int>(params.elevations.size());
  params.columns = 360;
  params.folded = true;
  return params;
}

LidarPattern::LidarPattern(const LidarParams& params) : params_(params) {
  for (int n = 0; n < params.columns; ++n) azimuth_.push_back(unit(2.0 * M_PI * n / params.columns));
  for (const double degrees : params.elevations) elevation_.push_back(unit(degrees * M_PI / 180.0));
  if (!params.elevations.empty()) return;
  for (int n = 0; n < params.rings; ++n) {
    const double step = params.rings > 1 ? (params.highest - params.lowest) / (params.rings - 1) : 0.0;
    elevation_.push_back(unit(params.rings > 1 ? (params.lowest + n * step) * M_PI / 180.0 : 0.0));
  }
}

/// The beams of one direction, folded to one return: walks outwards from the robot's feet, beam by beam.
/// Ground goes on as it rose so far, within a step and what slopes may change.
class LidarPattern::Column {
 public:
  Column(const LidarParams& params, double height) : params_(params), height_(height) {}

  /// Takes the beams in, the lowest first. `cast` gives the true range at another elevation (cos, sin).
  template <class Cast>
  void take(std::span<const Beam> beams, const Cast& cast) {
    for (std::size_t n = 0; n < beams.size(); ++n) {
      const bool last = n + 1 == beams.size();
      take(beams[n], last ? VoxelGrid::kNoHit : beams[n + 1].range * beams[n + 1].elevation.x(), cast);
    }
  }

  /// Distance of the return in the plane, m; infinite: all is ground, or out of sight.
  double distance() const { return measured_; }

 private:
  /// `above`: distance of what the next beam met, m.
  template <class Cast>
  void take(const Beam& beam, double above, const Cast& cast) {
    if (beam.measured < params_.min_range) return;
    const bool met = beam.measured <= params_.max_range;
    const double flat = beam.measured * beam.elevation.x();
    const double z = height_ + beam.measured * beam.elevation.y();
    if (met && stands(flat, z)) {
      const double distance = beam.range * beam.elevation.x();
      // Two beams that meet the same distance met a face. Else it may be the top of something low, which
      // would go along with the robot: its face is nearer.
      const bool face = beam.elevation.y() >= 0.0 || above - distance < kFace;
      const double front = face ? distance : front_of(beam, cast);
      return offer(front, front + flat - distance);
    }
    if (beam.elevation.y() >= 0.0) return;
    const double level = (height_ - ground_) * beam.elevation.x() / -beam.elevation.y();
    if (met ? z < ground_ - params_.drop : level < kSurelyGround)
      if (const auto edge = drop_before(beam, cast)) {
        const double noise = met ? beam.measured - beam.range : 0.0;
        return offer(*edge, *edge + noise);
      }
    if (!met || flat <= reach_ + kApart) return;
    rise_ = std::clamp((z - ground_) / (flat - reach_), -kSteepest, kSteepest);
    reach_ = flat;
    ground_ = z;
    lowest_ = beam.elevation;
  }

  static constexpr double kBend = 0.12;         ///< Change of slope from beam to beam, rise per run.
  static constexpr double kSteepest = 0.5;      ///< Steepest ground, rise per run.
  static constexpr double kSpan = 3.0;          ///< Longest span over which ground bends, m.
  static constexpr double kFace = 0.1;          ///< Depth within which beams meet one face, m.
  static constexpr double kApart = 0.05;        ///< Closer returns give no slope, m.
  static constexpr double kSurelyGround = 5.0;  ///< Within this, a beam without return means a pit, m.

  void offer(double true_distance, double measured) {
    if (true_distance >= nearest_) return;
    nearest_ = true_distance;
    measured_ = measured;
  }

  bool stands(double flat, double z) const {
    const double ahead = flat - reach_;
    return z - (ground_ + rise_ * std::min(ahead, kSpan)) >
           params_.step + kBend * std::clamp(ahead, 0.0, kSpan);
  }

  /// The nearest of what stands between the last beam that met ground and this one.
  template <class Cast>
  double front_of(const Beam& beam, const Cast& cast) const {
    double low = std::atan2(lowest_.y(), lowest_.x());
    double high = std::atan2(beam.elevation.y(), beam.elevation.x());
    double front = beam.range * beam.elevation.x();
    for (int n = 0; n < 5; ++n) {
      const double middle = 0.5 * (low + high);
      const Eigen::Vector2d way = unit(middle);
      const double range = cast(way), flat = range * way.x();
      const bool met = stands(flat, height_ + range * way.y());
      (met ? high : low) = middle;
      if (met) front = std::min(front, flat);
    }
    return front;
  }

  struct Hit {
    double flat, z;  ///< m
    bool met;
  };
  static double fall(const Hit& from, const Hit& to) {
    if (!to.met) return from.met ? VoxelGrid::kNoHit : 0.0;
    return (from.z - to.z) / std::max(to.flat - from.flat, 1e-3);
  }

  /// Where the ground ends between the last beam that met it and this one; nothing when it goes on, however
  /// steeply. Bisects for the steepest fall: at an edge a jump is left of it.
  template <class Cast>
  std::optional<double> drop_before(const Beam& beam, const Cast& cast) const {
    const auto hit = [&](const Eigen::Vector2d& way, double range) -> Hit {
      return {range * way.x(), height_ + range * way.y(), range <= params_.max_range};
    };
    double low = std::atan2(lowest_.y(), lowest_.x());
    double high = std::atan2(beam.elevation.y(), beam.elevation.x());
    Hit near{reach_, ground_, true}, far = hit(beam.elevation, beam.range);
    for (int n = 0; n < 6; ++n) {
      const double middle = 0.5 * (low + high);
      const Eigen::Vector2d way = unit(middle);
      const Hit between = hit(way, cast(way));
      const bool before = fall(near, between) >= fall(between, far);
      (before ? high : low) = middle;
      (before ? far : near) = between;
    }
    // What falls no more steeply may be ground behind a crest.
    const bool gentle = near.z - far.z <= params_.drop || fall(near, far) <= kBend;
    if (far.met && gentle) return std::nullopt;
    return near.flat;
  }

  const LidarParams& params_;
  double height_;
  double reach_{0.0}, ground_{0.0}, rise_{0.0};         ///< Last ground: distance, height, slope.
  Eigen::Vector2d lowest_{unit(-80.0 * M_PI / 180.0)};  ///< Beam that met it.
  double nearest_{VoxelGrid::kNoHit}, measured_{VoxelGrid::kNoHit};
};

PointCloud LidarPattern::scan(const World& world, std::span<const BodyBox> others, const Pose3& base,
                              double height, std::uint64_t seed) const {
  const Eigen::Matrix3d rotation = base.orientation.toRotationMatrix();
  const VoxelGrid::Start start = world.grid().locate(base.position + height * rotation.col(2));
  std::vector<BoxTarget> targets;
  for (const BodyBox& body : others) targets.push_back(make_target(body, start.position));
  const bool level = rotation.col(2) == Eigen::Vector3d::UnitZ();
  Random random(seed);
  PointCloud points;
  points.reserve(size());
  std::vector<Eigen::Vector3d> directions(elevation_.size());
  std::vector<double> ranges(elevation_.size());
  std::vector<Beam> beams(params_.folded ? elevation_.size() : 0);
  const auto add = [&points](const Eigen::Vector2d& azimuth, double flat, double z) {
    points.emplace_back(static_cast<float>(flat * azimuth.x()), static_cast<float>(flat * azimuth.y()),
                        static_cast<float>(z));
  };
  for (const Eigen::Vector2d& azimuth : azimuth_) {
    const Eigen::Vector3d ahead = rotation.col(0) * azimuth.x() + rotation.col(1) * azimuth.y();
    const auto direction = [&](const Eigen::Vector2d& elevation) -> Eigen::Vector3d {
      return ahead * elevation.x() + rotation.col(2) * elevation.y();
    };
    const auto in_the_way = [&](const BoxTarget& target) {
      return !level || ahead.head<2>().dot(target.towards) >= target.cos_spread;
    };
    for (std::size_t n = 0; n < elevation_.size(); ++n) directions[n] = direction(elevation_[n]);
    world.grid().cast(start, directions, params_.max_range, ranges);
    for (const BoxTarget& target : targets)
      if (in_the_way(target))
        for (std::size_t n = 0; n < elevation_.size(); ++n)
          ranges[n] = std::min(ranges[n], cast_box(target, directions[n]));
    // Drawn for every beam, so that a robot in the way of some leaves the noise of the others alone.
    const auto measure = [&](std::size_t n) { return ranges[n] + params_.range_noise * gaussian(random); };
    if (params_.folded) {
      const auto cast = [&](const Eigen::Vector2d& elevation) {
        const Eigen::Vector3d way = direction(elevation);
        double range = world.grid().cast(start, way, params_.max_range);
        for (const BoxTarget& target : targets)
          if (in_the_way(target)) range = std::min(range, cast_box(target, way));
        return range;
      };
      for (std::size_t n = 0; n < elevation_.size(); ++n) beams[n] = {elevation_[n], ranges[n], measure(n)};
      Column column(params_, height);
      column.take(beams, cast);
      const double flat = column.distance();
      if (flat >= params_.min_range && flat <= params_.max_range) add(azimuth, flat, height);
      continue;
    }
    for (std::size_t n = 0; n < elevation_.size(); ++n) {
      const double range = measure(n);
      if (range >= params_.min_range && range <= params_.max_range)
        add(azimuth, range * elevation_[n].x(), height + range * elevation_[n].y());
    }
  }
  return points;
}

}  // namespace adit::sim
