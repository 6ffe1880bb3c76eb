// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Geometry>
#include <span>

#include "core/geometry/pose.hpp"
#include "perception/odometry/odometry_state.hpp"
#include "perception/voxel/voxel_planes.hpp"

namespace adit::perception {

/// Parameters of align(), which lays a cloud onto planes from a guess alone.
struct AlignParams {
  double range_noise{0.02};     ///< Standard deviation of a range, m, (0, 0.5].
  double search_distance{0.0};  ///< Poses so far from the guess are tried, too, horizontally, m, [0, 3].
  double search_angle{0.0};     ///< Also those that are turned so far about the vertical, rad, [0, pi].
  double window{1.0};           ///< A point so far from a plane still matches it at first, m, (0, 5].
  /// A direction that the cloud does not determine keeps the guess's value, as the height where no floor is
  /// seen. Otherwise it follows what few points say of it.
  bool keeps_undetermined{false};
  float voxel{0.25f};  ///< The source's points are averaged in voxels of this edge, m, [0.05, 5].
};

/// Less overlap says that a scan belongs elsewhere; scans of the same kind and a target of all places around.
inline constexpr double kAlignOverlap = 0.65;

/// Pose of a cloud in another one's frame, and how well it fits there.
struct Alignment {
  Pose3 pose{};  ///< T_target_source.
  /// Of the pose, in translation (target axes) and rotation (source axes, right-perturbed).
  Eigen::Matrix<double, 6, 6> information{Eigen::Matrix<double, 6, 6>::Zero()};
  /// Share of the points that lie on the target's planes, without floors and ceilings, which fit each other
  /// everywhere. In simulated halls 0.85 or more where the target was seen before, 0.5 or less in another
  /// one; kAlignOverlap lies between.
  double overlap{};
  double rmse{};  ///< Distance from their planes of the points that lie on one, m.
  Localizability localizability{};
  bool converged{};
};

/// The planes of a cloud (or of several, in one frame, m) as a target of align().
VoxelPlanes align_target(std::span<const Eigen::Vector3f> points, double range_noise = 0.03);

/// Lays a cloud onto the planes of others: poses around the guess are compared by a truncated distance, and
/// the best ones are refined from coarse to fine by Gauss-Newton on the distances from planes.
///
/// Points and planes in m; the vertical is z. Pure, single-threaded, and deterministic.
/// @param source  Of one scan or more, any order; points that are not finite are left out.
/// @param guess   T_target_source.
Alignment align(const VoxelPlanes& target, std::span<const Eigen::Vector3f> source, const Pose3& guess,
                const AlignParams& params = {});

}  // namespace adit::perception
