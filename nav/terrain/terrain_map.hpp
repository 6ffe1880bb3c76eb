// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>

#include "core/config/platform.hpp"
#include "core/config/traversability.hpp"
#include "nav/terrain/drops.hpp"
#include "nav/terrain/obstacle_cells.hpp"
#include "nav/terrain/surface.hpp"
#include "nav/terrain/terrain_cell.hpp"

namespace adit::nav {

/// What the ground around the robot is to its platform, from registered scans, in a grid that rolls with it:
/// ground (GroundGrid), what stands and hangs in the way (ObstacleCells), missing ground (Drops), and what
/// the rest costs (Surface). What stands higher above the ground than the platform's step and lower than body
/// and lidar is in the way; what hangs higher is passed under. Allocates nothing once it has seen a scan of
/// its lidar's size.
class TerrainMap {
 public:
  /// What a cell of the ground is to the platform.
  enum class Kind : std::uint8_t { unknown, ground, step, slope, obstacle, drop };

  explicit TerrainMap(const Platform& platform, const TerrainParams& params = {});

  /// Takes one scan. `points`: in base_link, m, not finite or within min_range of the lidar (which is
  /// lidar_height above base_link) where nothing was hit. `body`: base_link, which is on the ground, in the
  /// odometry frame at the scan's time. `stamp_s`: that time, s, not decreasing.
  void add_scan(std::span<const Eigen::Vector3f> points, const Pose3& body, double stamp_s);

  /// All that costs something; valid until the next scan. Where several layers have a place each has a cell.
  std::span<const TerrainCell> cells() const { return cells_; }
  /// As many cells as there can be.
  std::size_t max_cells() const { return obstacles_.max_cells() + ground_.cells() * 9 / 4; }
  const GroundGrid& ground() const { return ground_; }
  /// What each cell of the ground's window is, by index; the layers that block before those that cost.
  void classify_cells(std::vector<Kind>& kinds) const;
  /// Height of the map's ground above that of the odometry frame, m: see GroundGrid.
  double lift() const { return static_cast<double>(lift_); }
  /// How much more the map's ground rises per metre along x and y than the body's attitude says: see
  /// GroundGrid.
  const Eigen::Vector2f& tilt_error() const { return tilt_error_; }
  /// How the ground around the robot rises, per metre along x and y, whatever the body does.
  const Eigen::Vector2f& ground_gradient() const { return ground_.plane().gradient; }
  /// Forgets everything, as after a jump of the odometry.
  void clear();

 private:
  void sort_in(std::span<const Eigen::Vector3f> points, const View& view);
  void register_scan(const Pose3& body, View& view, GroundGrid::Offset& offset);
  void mark_obstacles(const View& view);
  /// Whether a return lies so far below the ground that the ground is missing there.
  bool is_below(const Eigen::Vector3f& p) const;
  void find_drops(const View& view, float farthest);
  void write_drops();
  void write_cells();

  Platform platform_;
  TerrainParams params_;
  Traversability limits_;
  Footprint body_;
  GroundGrid ground_;
  ObstacleCells obstacles_;
  Drops drops_;
  Surface surface_;
  RayBlock block_{};
  RayImage rays_{};
  std::vector<Eigen::Vector3f> near_{};   ///< returns within range, in the map
  std::vector<Eigen::Vector2f> under_{};  ///< of those within range: nearly as high as an obstacle
  std::vector<Eigen::Vector3f> deep_{};   ///< whose ray went below the ground within range
  std::vector<std::uint8_t> solid_;       ///< cells of the ground's window with an obstacle in them
  std::vector<std::uint8_t> drop_;        ///< and those that are written as a drop that blocks
  std::vector<TerrainCell> cells_{};
  Pose3 last_body_{};
  double epoch_{0};
  float now_{0};
  float lift_{0};
  Eigen::Vector2f tilt_error_{0, 0};
  bool begun_{false};
};

}  // namespace adit::nav
