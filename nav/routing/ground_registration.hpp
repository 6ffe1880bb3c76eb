// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/geometry/pose.hpp"
#include "nav/routing/surface_map.hpp"

namespace adit::nav {

/// Registers the height, roll and pitch of scans against the ground of a SurfaceMap.
///
/// An attitude error of 1 degree moves ground 10 m away by 0.17 m, which would be a step beside ground that
/// another scan measured. A share of each correction is left to the reported pose, so an error of the
/// first scan does not tilt the map for ever, and the map's heights follow those of the odometry.
class GroundRegistration {
 public:
  /// Returns the pose `body` with height, roll and pitch corrected. `points`: base_link, m; `body`: map
  /// frame.
  Pose3 apply(std::span<const Eigen::Vector3f> points, const Pose3& body, const SurfaceMap& map);
  /// The same correction of another pose of about that time.
  Pose3 correct(const Pose3& body) const;
  /// Height of the scan's ground under the reported pose above the map's ground, m.
  float height() const { return height_; }
  /// The map was raised by so much, m.
  void map_raised(float by) { height_ -= by; }
  /// Forgets the correction.
  void clear() {
    gradient_.setZero();
    height_ = 0.0f;
  }

 private:
  /// Rise of level ground per metre under the reported attitude, map frame.
  Eigen::Vector2f gradient_{0, 0};
  float height_{0};
  std::vector<Eigen::Vector3f> samples_{};
};

}  // namespace adit::nav
