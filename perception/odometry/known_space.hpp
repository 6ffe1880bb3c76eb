// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Geometry>
#include <span>

#include "core/geometry/pose.hpp"
#include "perception/voxel/flat_hash.hpp"
#include "perception/voxel/voxel_planes.hpp"

namespace adit::perception {

/// The space that the lidar saw empty, in voxels of half a metre. Bounded.
class KnownSpace {
 public:
  static constexpr double kEdge = 0.5;               ///< m
  static constexpr std::size_t kMaxVoxels = 60'000;  ///< A hall of 30 x 40 x 6 m.

  /// Adds the space between the lidar and what it saw, as far as 20 m.
  void add(const Eigen::Vector3d& lidar, std::span<const Eigen::Vector3d> points, double travelled);
  /// Forgets voxels that were last seen empty more than 60 m ago; a bounded part in each call.
  void forget(double travelled);
  bool is_empty(const Eigen::Vector3d& place) const;

 private:
  FlatHash<float> voxels_{};  ///< Travelled distance when it was seen empty.
  std::size_t sweep_{};
};

/// How far a cloud agrees with what was seen before. Floors and ceilings, which fit each other everywhere,
/// and points in space that was never seen do not count.
struct Agreement {
  double agree{};       ///< Points on known upright planes.
  double contradict{};  ///< Points in space that was empty, or behind a known plane.
  double share() const { return agree > 0 ? agree / (agree + contradict) : 0.0; }
};

/// Compares some of the points of a cloud; those that contradict are looked for only when the share may be
/// below `enough`.
///
/// @param points  Body frame, m; the lidar is at its origin, within a metre.
/// @param pose    Of the body, in the frame of the map.
Agreement agreement(const VoxelPlanes& map, const KnownSpace& space, std::span<const Eigen::Vector3f> points,
                    const Pose3& pose, double range_noise, double enough);

}  // namespace adit::perception
