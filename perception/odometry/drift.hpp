// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>

#include "perception/odometry/odometry_state.hpp"

namespace adit::perception {

/// Accounts for the error of a pose since the start.
///
/// The covariance of the filter is that of the pose in the local map, which itself drifts away. The drift is
/// the sum of two parts: where the lidar determines a direction, one error of registration each time the map
/// in view was replaced; where it does not, the growth of the filter's own variance.
class DriftAccount {
 public:
  using Matrix6 = Eigen::Matrix<double, 6, 6>;

  // Errors of a registration that its residuals do not show: bias of the lidar, of its mounting and of its
  // times. The simulator's and the drivers' documentation bound them (1 cm, 0.05 degrees); the standard
  // deviation of what lies anywhere within a bound is that bound by the square root of three.
  static constexpr double kBiasT = 0.0058;  ///< Of the position, m.
  static constexpr double kBiasR = 0.0005;  ///< Of the rotation, rad.

  /// Adds an error that is known only by its standard deviations: position (odom, m), rotation (odom axes,
  /// rad).
  void raise(const Eigen::Matrix<double, 6, 1>& sigma) { sum_.diagonal() += sigma.cwiseAbs2(); }
  void clear() { sum_.setZero(); }
  /// @param moved   How far the body moved since the last call, odom, m.
  /// @param turned  By how much it turned, rad.
  /// @param reach   How far the lidar sees, m: after that way the map in view is another one.
  /// @param before, after  Covariance of the filter's pose after the last sweep and now: position and
  /// rotation,
  ///     odom axes.
  void add(const Eigen::Vector3d& moved, double turned, double reach, const Localizability& found,
           const Matrix6& before, const Matrix6& after);
  /// Of the pose since the start: position (odom, m), rotation (odom axes, rad).
  const Matrix6& covariance() const { return sum_; }

 private:
  Matrix6 sum_{Matrix6::Zero()};
};

}  // namespace adit::perception
