// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>

#include "core/config/platform.hpp"
#include "core/config/traversability.hpp"
#include "core/geometry/scan_points.hpp"
#include "core/geometry/staircase.hpp"
#include "nav/terrain/drops.hpp"
#include "nav/terrain/obstacle_cells.hpp"
#include "nav/terrain/surface.hpp"

namespace adit::nav {

/// Traversability map around the robot, from scans that are registered in a grid that rolls with it: ground
/// (GroundGrid), obstacles (ObstacleCells), missing ground (Drops), and the cost of the remaining ground
/// (Surface). A return is an obstacle when it is higher above the ground than the platform's step and lower
/// than the body and the lidar; the robot passes under what hangs higher. Allocates nothing after the first
/// scan of its lidar's size.
class TerrainMap {
 public:
  static constexpr double kMinRange = 0.05;  ///< Shorter ranges are no returns, m.

  /// `range`: radius of the map around the robot, m, [1, 20].
  explicit TerrainMap(const Platform& platform, double range = 4.5);

  /// Takes one scan; points are not finite, or within kMinRange of their lidar, where there was no return.
  /// `body`: base_link, which is on the ground, in the odometry frame at the scan's time. `stamp_s`: that
  /// time, s, not decreasing.
  void add_scan(const ScanPoints& scan, const Pose3& body, double stamp_s);

  /// Sets the known staircases, frame of the poses. On one that the platform climbs no ground is missing:
  /// from a floor above, its own edge hides steps that are steeper than the ray over it.
  void set_stairs(std::span<const Staircase> stairs);

  const GroundGrid& ground() const { return ground_; }
  const ObstacleCells& obstacles() const { return obstacles_; }
  const Drops& drops() const { return drops_; }
  const Surface& surface() const { return surface_; }
  /// Whether a place belongs to a staircase that leads from the robot's height, or to the floor at its ends.
  bool is_on_stairs(const Eigen::Vector2f& at) const;
  /// Time since an obstacle was first seen, s.
  float age(const ObstacleCells::Entry& entry) const { return now_ - entry.since; }
  /// Maximum number of places with a cost.
  std::size_t max_places() const { return obstacles_.max_cells() + ground_.cells() * 9 / 4; }
  /// Height of the map's datum above that of the odometry frame, m: see GroundGrid.
  double height_correction() const { return static_cast<double>(height_correction_); }
  /// Error of the body's attitude: additional rise of the map's ground per metre along x and y: see
  /// GroundGrid.
  const Eigen::Vector2f& tilt_error() const { return tilt_error_; }
  /// Forgets everything, for example after a jump of the odometry.
  void clear();

 private:
  void sort_in(const ScanPoints& scan, const View& view);
  /// Sorts in what one lidar measured from `sensor`, base_link, m; `deep`: whether its rays show drops.
  void sort_in(std::span<const Eigen::Vector3f> points, const Eigen::Vector3f& sensor, bool deep,
               LidarRangeImage& rays, const View& view);
  void register_scan(const Pose3& body, View& view, GroundGrid::Offset& offset);
  void mark_obstacles(const View& view);
  /// Whether a return is so far below the ground that the ground is missing there.
  bool is_below(const Eigen::Vector3f& p) const;
  void find_drops(const View& view, float farthest);

  Platform platform_;
  double range_;  ///< m
  Traversability limits_;
  Footprint body_;
  GroundGrid ground_;
  ObstacleCells obstacles_;
  Drops drops_;
  Surface surface_;
  RayBlock block_{};
  LidarRangeImage rays_{};                   ///< Of the first lidar.
  std::vector<ObstacleCells::Seen> more_{};  ///< Of the others.
  std::vector<Eigen::Vector3f> near_{};  ///< Returns within range, in the map frame; the first lidar's first.
  std::size_t near_of_first_{};
  std::vector<Eigen::Vector2f> under_{};  ///< Those of them nearly as high as an obstacle.
  std::vector<Eigen::Vector3f> deep_{};   ///< Returns whose ray went below the ground within range.
  std::vector<std::uint8_t> solid_;       ///< Marks the cells of the ground's window with an obstacle.
  std::vector<Staircase> stairs_{};       ///< Those that the platform climbs.
  Pose3 last_body_{};
  double epoch_{0};
  float now_{0};
  float height_correction_{0};
  Eigen::Vector2f tilt_error_{0, 0};
  bool begun_{false};
};

}  // namespace adit::nav
