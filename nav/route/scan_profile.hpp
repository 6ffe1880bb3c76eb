// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <span>
#include <vector>

#include "core/config/platform.hpp"
#include "core/config/traversability.hpp"
#include "core/geometry/pose.hpp"
#include "nav/route/surface_map.hpp"

namespace adit::nav {

/// Reads ground and obstacles from a scan, direction by direction: outwards from under the robot the ground
/// goes on as long as slope and step allow; what stands higher is an obstacle, what hangs high enough is
/// passed under, and a ray that went through where ground should be found a hole. (M. Himmelsbach et al.,
/// *Fast segmentation of 3D point clouds for ground vehicles*, 2010, has the directions.) A lidar of one
/// level ring sees no ground; then what is before an obstacle is as high as under the robot.
class ScanProfile {
 public:
  ScanProfile(const Platform& platform, const RouteParams& params);
  /// So much higher or lower than the ground before it something may pass for ground, m.
  static float most_wrong(const Platform& platform);

  /// `points`: in base_link, m, not finite or on the own body where nothing was hit. `body`: in the map's
  /// frame.
  void add(std::span<const Eigen::Vector3f> points, const Pose3& body, SurfaceMap& map);

 private:
  ScanProfile(const Platform& platform, const RouteParams& params, const Traversability& limits);
  static constexpr int kDirections = 360;
  static constexpr int kQuarter = kDirections / 4;
  struct Return {
    float range, x, y, z;
  };
  /// A piece of ground between two ranges, seen by a ray that is `height` above the ground at its end.
  struct Piece {
    float from, to, z_from, z_to, ray_z;  ///< ray_z: of the ray at `to`
  };
  /// The first obstacle of a direction; range 0: none.
  struct Hit {
    float range{0}, x{0}, y{0}, base{0}, top{0};
  };
  /// A cell by its distance from the sensor's.
  struct SectorCell {
    std::int16_t dx, dy;
    float range;  ///< of its middle, m
  };
  void sort(std::span<const Eigen::Vector3f> points, const Pose3& body);
  void walk(std::span<const Return> returns, SurfaceMap& map, Hit& hit);
  bool stands(std::span<const Return> returns, std::size_t which) const;
  bool is_face(std::span<const Return> returns, std::size_t which) const;
  void list_sectors();
  void write_free(int direction, std::span<const Piece> pieces, SurfaceMap& map) const;
  void close_gaps(SurfaceMap& map) const;
  void stand(const Pose3& body, SurfaceMap& map) const;
  /// Height of the plane that the body stands on, m.
  float ground_at(double x, double y) const;

  Platform platform_;
  RouteParams params_;
  float clear_, step_, drop_, slope_;
  Eigen::Vector3f sensor_{0, 0, 0};
  Eigen::Vector2f at_{0, 0}, lean_{0, 0};  ///< the body, and how much the ground below it rises per metre
  float ground_{0};                        ///< below the body
  std::vector<Return> sorted_{};
  std::vector<Return> unsorted_{};
  std::vector<int> direction_{};
  std::vector<int> begin_{};
  std::vector<Piece> pieces_{};
  std::array<Hit, kDirections> hits_{};
  std::vector<SectorCell> quarter_{};  ///< of the first 90 directions from +x on, by direction, nearest first
  std::array<std::size_t, kQuarter + 1> first_{};  ///< of each of these
};

}  // namespace adit::nav
