// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <span>
#include <vector>

#include "core/config/platform.hpp"
#include "core/config/traversability.hpp"
#include "core/geometry/pose.hpp"
#include "core/geometry/scan_points.hpp"
#include "nav/routing/near_ground.hpp"
#include "nav/routing/surface_map.hpp"

namespace adit::nav {

/// Extracts ground and obstacles from a scan, direction by direction. From under the robot outwards the
/// ground continues as far as slope and step permit. Higher returns are obstacles, returns above the
/// clearance height are ignored, and a ray that passed below the expected ground marks a hole. The sectors
/// follow M. Himmelsbach et al., *Fast segmentation of 3D point clouds for ground vehicles*, 2010. A lidar
/// with one level ring sees no ground; then the ground before an obstacle is taken to be as high as under the
/// robot. Near the robot a local map, if there is one, decides about what NearGround says.
class ScanProfile {
 public:
  ScanProfile(const Platform& platform, const RouteParams& params);
  /// Maximum height difference to the preceding ground at which a return may be taken for ground by mistake,
  /// m.
  static float most_wrong(const Platform& platform);

  /// Adds a scan to the map; points are not finite or on the robot itself where there was no return.
  /// `body`: map frame. `near`: empty where there is no local map.
  void add(const ScanPoints& scan, const Pose3& body, const NearGround& near, SurfaceMap& map);

 private:
  static constexpr int kDirections = 360;
  static constexpr int kQuarter = kDirections / 4;
  struct Return {
    float range, x, y, z;
  };
  /// A piece of ground between two ranges. `ray_z`: height of the ray at `to`, m.
  struct Piece {
    float from, to, z_from, z_to, ray_z;
  };
  /// The first obstacle in a direction; range 0: none.
  struct Hit {
    float range{0}, x{0}, y{0}, base{0}, obstacle_height{0};
  };
  /// A cell relative to the cell of the lidar's foot.
  struct SectorCell {
    std::int16_t dx, dy;
    float range;  ///< Of its centre, m.
  };
  /// From where a lidar looks.
  struct Viewpoint {
    Eigen::Vector3f lidar{0, 0, 0};   ///< base_link, m.
    Eigen::Vector3f sensor{0, 0, 0};  ///< The same place in the map, m.
    /// Its foot, map frame, m: where a line along the body's z through the lidar meets the plane of
    /// base_link, which is the ground. Ranges and directions are from there.
    Eigen::Vector2f at{0, 0};
    float ground{0};  ///< Height of the foot, m.
  };
  /// Of each direction, the end of its pieces; they begin where those of the direction before end.
  using Ends = std::array<std::size_t, kDirections>;
  struct Part {
    Viewpoint from;
    Ends ends;
  };
  static Viewpoint viewpoint(const Eigen::Vector3d& lidar, const Pose3& body);
  /// The obstacles that one lidar saw from from_, and the free pieces before them.
  void walk_all(std::span<const Eigen::Vector3f> points, const Pose3& body, SurfaceMap& map, Ends& ends);
  void sort(std::span<const Eigen::Vector3f> points, const Pose3& body);
  void walk(std::span<const Return> returns, SurfaceMap& map, Hit& hit);
  bool is_obstacle(std::span<const Return> returns, std::size_t which) const;
  bool is_face(std::span<const Return> returns, std::size_t which) const;
  void list_sectors();
  /// Writes a return at (x, y), `height` above the ground at z, unless the local map knows better.
  void see_obstacle(float x, float y, float z, float height, SurfaceMap& map) const;
  void write_free(int direction, std::span<const Piece> pieces, SurfaceMap& map) const;
  void close_gaps(SurfaceMap& map) const;
  void stand(const Pose3& body, SurfaceMap& map) const;
  /// Height of the plane under the body, m.
  float ground_at(double x, double y) const;

  Platform platform_;
  RouteParams params_;
  float clear_, step_, drop_, slope_;
  const NearGround* near_{};        ///< Of the scan that is added.
  Viewpoint from_{};                ///< Of the lidar whose returns are read.
  Eigen::Vector2f gradient_{0, 0};  ///< Of the ground under the body.
  std::vector<Part> parts_{};
  std::vector<Return> sorted_{};
  std::vector<Return> unsorted_{};
  std::vector<int> direction_{};
  std::vector<int> begin_{};
  std::vector<Piece> pieces_{};
  std::array<Hit, kDirections> hits_{};
  /// Cells of the 90 directions from +x on, by direction, nearest first.
  std::vector<SectorCell> quarter_{};
  std::array<std::size_t, kQuarter + 1> first_{};  ///< Index of the first cell of each of these directions.
};

}  // namespace adit::nav
