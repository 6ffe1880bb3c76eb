// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Geometry>
#include <cmath>

namespace adit::perception {

/// The matrix of the cross product: skew(a) b = a x b.
inline Eigen::Matrix3d skew(const Eigen::Vector3d& a) {
  Eigen::Matrix3d m;
  m << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return m;
}

/// The rotation by a rotation vector, rad.
inline Eigen::Quaterniond exp_so3(const Eigen::Vector3d& v) {
  const double angle = v.norm();
  const double s = angle < 1e-8 ? 0.5 : std::sin(angle / 2) / angle;
  return Eigen::Quaterniond(angle < 1e-8 ? 1.0 : std::cos(angle / 2), s * v.x(), s * v.y(), s * v.z())
      .normalized();
}

/// The rotation vector of a rotation, rad, of length [0, pi].
inline Eigen::Vector3d log_so3(const Eigen::Quaterniond& rotation) {
  const Eigen::Quaterniond q =
      rotation.w() < 0 ? Eigen::Quaterniond(-rotation.coeffs()) : rotation;  // The shorter way round.
  const double s = q.vec().norm();
  return s < 1e-10 ? Eigen::Vector3d(2 * q.vec()) : Eigen::Vector3d(2 * std::atan2(s, q.w()) / s * q.vec());
}

/// The smallest rotation that turns the direction of `from` into that of `to`; neither is zero. Opposite
/// directions are half a turn apart about any axis across them. Eigen's FromTwoVectors takes a singular value
/// decomposition for those, which costs seven seconds of compiling in each file that calls it.
inline Eigen::Quaterniond rotation_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const Eigen::Vector3d a = from.normalized(), b = to.normalized();
  const double c = b.dot(a);
  if (c < -1 + 1e-12) {
    const Eigen::Vector3d across = a.unitOrthogonal();
    return Eigen::Quaterniond(0, across.x(), across.y(), across.z());
  }
  const double s = std::sqrt((1 + c) * 2);
  const Eigen::Vector3d axis = a.cross(b) / s;
  return Eigen::Quaterniond(s / 2, axis.x(), axis.y(), axis.z());
}

}  // namespace adit::perception
