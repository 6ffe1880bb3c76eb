// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>

namespace adit::perception {

/// Remembers that the wheels contradict another sensor, and by how much, until both agree for a second.
///
/// A contradiction is a bound of the error of a speed by the wheels, and no noise: it does not average out.
class SlipWatch {
 public:
  static constexpr double kGate = 12.0;  ///< Squared standard deviations.

  /// Compares a speed by the wheels with that by other sensors.
  ///
  /// @param off       Difference in body axes, m/s; 0 along axes that are not known.
  /// @param known     Variances of the other sensors, (m/s)2.
  /// @param variance  Of the wheels while they hold, (m/s)2.
  void compare(const Eigen::Vector3d& off, const Eigen::Vector3d& known, const Eigen::Vector3d& variance,
               double dt);
  /// The wheels stand.
  void rest(double dt);
  void clear() { *this = {}; }

  bool slipping() const { return bound_.maxCoeff() > 0; }
  bool lasts() const;  ///< It slips for longer than sensors differ when the body starts or stops.
  /// Largest error of a speed by the wheels, body axes, m/s; 0: as usual.
  const Eigen::Vector3d& bound() const { return bound_; }

 private:
  Eigen::Vector3d bound_{0, 0, 0};
  double agrees_for_{}, apart_for_{};  ///< s
};

}  // namespace adit::perception
