// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/geometry/pose.hpp"
#include "nav/route/surface_map.hpp"

namespace adit::nav {

/// Registers the height, roll and pitch of scans against the ground of a SurfaceMap.
///
/// An attitude that is wrong by 1 degree moves ground 10 m away by 0.17 m: beside ground that another scan
/// measured it would be a step. The correction fades towards the reported pose, so that an error of the first
/// scan does not tilt the map for ever, and the map's heights follow those of the odometry.
class GroundRegistration {
 public:
  /// The pose `body` with height, roll and pitch corrected. `points`: in base_link, m; `body`: in the map's
  /// frame.
  Pose3 apply(std::span<const Eigen::Vector3f> points, const Pose3& body, const SurfaceMap& map);
  /// Forgets the correction.
  void clear() {
    gradient_.setZero();
    height_ = 0.0f;
  }

 private:
  Eigen::Vector2f gradient_{0, 0};  ///< Rise of level ground by the reported attitude, per metre, map frame.
  float height_{0};                 ///< Of the map's ground by the reported pose, above the map's, m.
  std::vector<Eigen::Vector3f> samples_{};
};

}  // namespace adit::nav
