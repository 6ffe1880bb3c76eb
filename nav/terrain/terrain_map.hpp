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
  /// As many cells as there can be.
  static constexpr std::size_t kMaxCells =
      ObstacleCells::kMaxCells + std::size_t{GroundGrid::kSide * GroundGrid::kSide} * 9 / 4;

  explicit TerrainMap(const Platform& platform, const TerrainParams& params = {});

  /// Takes one scan. `points`: in base_link, m, not finite or within min_range of the lidar (which is
  /// lidar_height above base_link) where nothing was hit. `body`: base_link, which is on the ground, in the
  /// odometry frame at the scan's time. `stamp_s`: that time, s, not decreasing.
  void add_scan(std::span<const Eigen::Vector3f> points, const Pose3& body, double stamp_s);

  /// All that costs something; valid until the next scan. Where several layers have a place each has a cell.
  std::span<const TerrainCell> cells() const { return cells_; }
  const GroundGrid& ground() const { return ground_; }
  /// Height of the map's ground above that of the odometry frame, m: see GroundGrid.
  double lift() const { return static_cast<double>(lift_); }
  /// Forgets everything, as after a jump of the odometry.
  void clear();

 private:
  void sort_in(std::span<const Eigen::Vector3f> points, const View& view);
  void classify(const View& view);
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
  std::vector<Eigen::Vector3f> deep_{};   ///< those farther away that lie lower than level ground would
  std::vector<std::uint8_t> solid_;       ///< cells of the ground's window with an obstacle in them
  std::vector<std::uint8_t> drop_;        ///< and those that are written as a drop
  std::vector<TerrainCell> cells_{};
  Pose3 last_body_{};
  double epoch_{0};
  float now_{0};
  float lift_{0};
  bool begun_{false};
};

}  // namespace adit::nav
