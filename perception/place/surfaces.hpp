// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>

#include "core/geometry/pose.hpp"
#include "perception/place/keyframe.hpp"

namespace adit::perception {

/// The points of a scan as what is compared with keyframes: those of one ring as pieces of walls.
PointCloud surfaces_of(std::span<const Eigen::Vector3f> points, bool planar);

/// The points of the keyframes within `radius` (m) of a pose, in its frame; the nearest keyframes first, at
/// most `most` of them, and none within `apart` (m) of another. Relative to `T_odom_guess`, which may be far
/// from the frame's origin.
PointCloud surfaces_near(std::span<const Keyframe> keyframes, const Pose3& T_odom_guess, double radius,
                         std::size_t most, double apart = 0.0);

/// From a guess to the pose `T_guess_found` in its frame, odometry frame: a shift and a turn about the
/// vertical.
Pose3 level_correction(const Pose3& T_odom_guess, const Pose3& T_guess_found);

}  // namespace adit::perception
