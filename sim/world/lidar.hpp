// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/pose.hpp"
#include "sim/world/world.hpp"

namespace adit::sim {

/// A spinning lidar.
struct LidarParams {
  int rings{16};             ///< Beams one above the other, [1, 128].
  int columns{900};          ///< Directions per turn, [4, 4096].
  double lowest{-15.0};      ///< Elevation of the lowest ring, degrees, [-89, 89]; a single ring is level.
  double highest{15.0};      ///< Elevation of the highest ring, degrees, [lowest, 89].
  double rate{10.0};         ///< Turns per second, Hz, (0, 100].
  double min_range{0.3};     ///< Closer hits are lost, m, [0, max_range).
  double max_range{30.0};    ///< Farther hits are lost, m, (0, 1000].
  double range_noise{0.02};  ///< Standard deviation of a range, m, [0, 1].

  /// Elevations of the rings, degrees, rising; empty: evenly from lowest to highest.
  std::vector<double> elevations{};
  /// The beams of each column are elsewhere within the steps between them, and never twice the same, as those
  /// of a lidar that scans a rosette (Livox). See SweepJob.
  bool rosette{false};
  /// One return a column, in the lidar's plane: the nearest of what the rings of that column show not to be
  /// ground.
  bool folded{false};
  double step{0.08};  ///< Folded: rise that is ground, m, [0, 1].
  double drop{0.15};  ///< Folded: fall that is none, m, (0, 10].

  /// Five rings folded to 360 columns: for many seeds.
  static LidarParams planar();
};

/// Another robot as a lidar sees it: a box that stands on the ground.
struct BodyBox {
  Pose2 pose{};     ///< Pose of its centre, world.
  double ground{};  ///< z of its underside, m
  double length{}, width{}, height{};
};

/// The directions of a lidar's beams, computed once and shared by all scans.
class LidarPattern {
 public:
  explicit LidarPattern(const LidarParams& params);
  const LidarParams& params() const { return params_; }
  /// Returns of one turn at most.
  std::size_t size() const { return azimuth_.size() * (params_.folded ? 1 : elevation_.size()); }

  /// Directions of a column, cosine and sine; those of its beams above the sensor's plane, rising.
  const std::vector<Eigen::Vector2d>& azimuths() const { return azimuth_; }
  const std::vector<Eigen::Vector2d>& elevations() const { return elevation_; }

  /// One turn, taken at one instant, of a sensor at `height` above the ground point `base` (world).
  /// Points are in base_link: origin on the ground under the robot's centre, x forward, z up, as level as
  /// `base` is; at most size() of them, column by column, in each from the lowest ring up; beams that hit
  /// nothing are left out. A folded scan has the points of the lidar's plane, at z = height: an obstacle
  /// stands where a ray met it, a drop begins where the last ground was seen. Depends on the arguments alone,
  /// so scans may run in parallel.
  PointCloud scan(const World& world, std::span<const BodyBox> others, const Pose3& base, double height,
                  std::uint64_t seed) const;

 private:
  class Column;
  LidarParams params_;
  std::vector<Eigen::Vector2d> azimuth_;    ///< Cosine and sine.
  std::vector<Eigen::Vector2d> elevation_;  ///< Cosine and sine.
};

}  // namespace adit::sim
