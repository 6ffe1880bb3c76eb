// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

#include "core/geometry/pose.hpp"

namespace adit::nav {

/// Viewpoint of a scan: the place of a lidar, and the axes of the body.
struct View {
  Eigen::Matrix3f turn{Eigen::Matrix3f::Identity()};  ///< Rotation from base_link to the map.
  Eigen::Vector3f sensor{0, 0, 0};                    ///< Lidar in the map, m.
  Eigen::Vector3f base{0, 0, 0};                      ///< base_link in the map, m.
  Eigen::Vector3f lidar{0, 0, 0};                     ///< The lidar in base_link, m.

  View() = default;
  /// `at`: the lidar in base_link, m.
  View(const Pose3& body, const Eigen::Vector3d& at)
      : turn(body.orientation.toRotationMatrix().cast<float>()),
        sensor((body * at).cast<float>()),
        base(body.position.cast<float>()),
        lidar(at.cast<float>()) {}
  void raise(float by) {
    sensor.z() += by;
    base.z() += by;
  }
  /// Tilts the body about base_link, so that the map rises by `gradient` more per metre.
  void tilt_by(const Eigen::Vector2f& gradient) {
    const Eigen::Vector3f axis(gradient.y(), -gradient.x(), 0);
    const float angle = axis.norm();
    if (angle < 1e-6f) return;
    const Eigen::Matrix3f rotation = Eigen::AngleAxisf(std::atan(angle), axis / angle).toRotationMatrix();
    turn = rotation * turn;
    sensor = base + rotation * (sensor - base);
  }
  /// The lidar from base_link, along the map's x and y, m.
  Eigen::Vector2f aside() const { return (turn * Eigen::Vector3f(lidar.x(), lidar.y(), 0)).head<2>(); }
  /// Converts a point of base_link into the map. Eigen does not inline `base + turn * p`, which runs for
  /// every return; this adds in the same order.
  Eigen::Vector3f in_map(const Eigen::Vector3f& p) const {
    const auto along = [&](int row) {
      return base[row] + (turn(row, 0) * p.x() + (turn(row, 1) * p.y() + turn(row, 2) * p.z()));
    };
    return {along(0), along(1), along(2)};
  }
  /// Converts a point of the map into the lidar's frame.
  Eigen::Vector3f seen(float x, float y, float z) const {
    return turn.transpose() * (Eigen::Vector3f(x, y, z) - sensor);
  }
  /// Converts a vertical distance of the map into the lidar's frame.
  Eigen::Vector3f up(float height) const { return height * turn.row(2).transpose(); }
  /// Attitude of the body: rise per metre along the map's x and y.
  Eigen::Vector2f tilt() const {
    const Eigen::Vector3f up = turn.col(2);
    if (up.z() < 0.5f) return {0, 0};
    return {-up.x() / up.z(), -up.y() / up.z()};
  }
};

}  // namespace adit::nav
