// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <vector>

namespace adit {

/// Wraps an angle to (-pi, pi], rad.
inline double wrap_angle(double angle) {
  angle = std::remainder(angle, 2.0 * M_PI);
  return angle <= -M_PI ? angle + 2.0 * M_PI : angle;
}

/// A planar pose, m and rad (REP-103): the transform from its own frame to the frame in which it is given.
struct Pose2 {
  double x{};
  double y{};
  double yaw{};

  /// Composition: `b` is given in this pose's frame.
  Pose2 operator*(const Pose2& b) const {
    const double c = std::cos(yaw), s = std::sin(yaw);
    return {x + c * b.x - s * b.y, y + s * b.x + c * b.y, wrap_angle(yaw + b.yaw)};
  }
  /// Transforms a point from this pose's frame to the frame in which the pose is given.
  Eigen::Vector2d operator*(const Eigen::Vector2d& p) const {
    const double c = std::cos(yaw), s = std::sin(yaw);
    return {x + c * p.x() - s * p.y(), y + s * p.x() + c * p.y()};
  }
  Pose2 inverse() const {
    const double c = std::cos(yaw), s = std::sin(yaw);
    return {-c * x - s * y, s * x - c * y, wrap_angle(-yaw)};
  }
  Eigen::Vector2d position() const { return {x, y}; }
  bool operator==(const Pose2&) const = default;
};

/// A pose in the plane with its cosine and sine, which Pose2 computes again for each point that it
/// transforms. Its points are equal to those of Pose2 bit by bit.
class PlanarTransform {
 public:
  explicit PlanarTransform(const Pose2& pose)
      : x_(pose.x), y_(pose.y), cos_(std::cos(pose.yaw)), sin_(std::sin(pose.yaw)) {}

  /// Transforms a point from the pose's frame to the frame in which the pose is given, m.
  Eigen::Vector2d operator*(const Eigen::Vector2d& p) const {
    return {x_ + cos_ * p.x() - sin_ * p.y(), y_ + sin_ * p.x() + cos_ * p.y()};
  }

 private:
  double x_, y_, cos_, sin_;
};

/// The inverse of a pose in the plane, in float, for many points: from the frame in which the pose is given
/// to the pose's own frame.
struct IntoPose {
  float x, y, cos, sin;

  explicit IntoPose(const Pose2& pose)
      : x(static_cast<float>(pose.x)),
        y(static_cast<float>(pose.y)),
        cos(static_cast<float>(std::cos(pose.yaw))),
        sin(static_cast<float>(std::sin(pose.yaw))) {}
  /// Turns a direction into the pose's axes.
  Eigen::Vector2f turn(float dx, float dy) const { return {cos * dx + sin * dy, cos * dy - sin * dx}; }
  /// Transforms a point, m.
  Eigen::Vector2f operator()(float px, float py) const { return turn(px - x, py - y); }
};

/// A pose in space: position in m, orientation as a unit quaternion.
struct Pose3 {
  Eigen::Vector3d position{Eigen::Vector3d::Zero()};
  Eigen::Quaterniond orientation{Eigen::Quaterniond::Identity()};

  Pose3 operator*(const Pose3& b) const {
    return {position + orientation * b.position, orientation * b.orientation};
  }
  Eigen::Vector3d operator*(const Eigen::Vector3d& p) const { return position + orientation * p; }
  Pose3 inverse() const {
    const Eigen::Quaterniond q = orientation.conjugate();
    return {q * -position, q};
  }
  double yaw() const {
    const auto& q = orientation;
    return std::atan2(2.0 * (q.w() * q.z() + q.x() * q.y()), 1.0 - 2.0 * (q.y() * q.y() + q.z() * q.z()));
  }
  Pose2 planar() const { return {position.x(), position.y(), yaw()}; }
  /// Returns the level pose that has the planar pose `p` and height z.
  static Pose3 level(const Pose2& p, double z) {
    return {{p.x, p.y, z}, Eigen::Quaterniond(Eigen::AngleAxisd(p.yaw, Eigen::Vector3d::UnitZ()))};
  }
  bool operator==(const Pose3& b) const {
    return position == b.position && orientation.coeffs() == b.orientation.coeffs();
  }
};

/// A velocity in the body frame: m/s forward, m/s to the left, rad/s counter-clockwise; for aerial robots
/// also m/s up.
struct Twist2 {
  double vx{};
  double vy{};
  double wz{};
  double vz{};
  bool operator==(const Twist2&) const = default;
  bool zero() const { return vx == 0.0 && vy == 0.0 && wz == 0.0 && vz == 0.0; }
};

/// Points, m, in the frame that the owner documents.
using PointCloud = std::vector<Eigen::Vector3f>;

}  // namespace adit
