// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "core/geometry/pose.hpp"
#include "sim/world/chassis.hpp"
#include "sim/world/noise.hpp"

namespace adit::sim {

/// How wrong a robot's odometry is.
struct OdometryParams {
  double scale{0.01};       ///< Standard deviation of the distance scale, fraction, [0, 0.5].
  double drift{0.2};        ///< Standard deviation of the heading error, degrees per metre, [0, 45].
  double correlation{1.0};  ///< Correlation length of the heading's error rate, m, (0, 1000].
  double turn{0.0};         ///< Standard deviation of the turn scale, fraction, [0, 0.5].
  double tilt{0.0};         ///< Standard deviation of the error of roll and pitch, degrees, [0, 10].
  double tilt_time{2.0};    ///< Time over which that error keeps its value, s, (0, 1000].
  double slips{0.0};        ///< Slip events a metre, 1/m, [0, 10].
  double altimeter{0.0};    ///< Deviation of the height error of a flying body, m, [0, 10].

  /// A real robot's: with tilt errors and slip.
  static OdometryParams realistic();
  /// All errors multiplied by `noise`; 0: none.
  OdometryParams scaled(double noise) const;
};

/// Standard deviations that a driver states with its odometry.
struct OdometrySigma {
  double position{};  ///< x and y since the start, m.
  double height{};    ///< m.
  double tilt{};      ///< Roll and pitch, rad.
  double yaw{};       ///< Since the start, rad.
  double speed{};     ///< m/s.
  double turn{};      ///< rad/s.
};

/// Dead reckoning with errors. A constant factor, drawn once, multiplies every distance (wheels worn, feet
/// slipping): 1 % of distance. The heading drifts by a rate per metre that wanders around zero (a
/// Gauss-Markov process over the driven way with the given deviation and correlation): 0.2 degrees per metre,
/// nearly independent from one metre to the next. A robot that stands or turns on the spot gains no error,
/// but where it skids: there a constant factor multiplies every turn, too.
///
/// Roll and pitch come from an attitude filter whose error is a Gauss-Markov process over time; because the
/// height is integrated along the measured slope, that error also makes it drift. In a slip event the wheels
/// or feet count up to 40 % more than the body moves, for up to 0.4 m.
class Odometry {
 public:
  Odometry(const OdometryParams& params, std::uint64_t seed);

  /// Takes the true motion of one step: from one pose to the next, over `dt` seconds.
  void move(const Pose2& from, const Pose2& to, double dt);
  /// The ground under the robot rose by so much, m: measured by how the body leaned on the way.
  void rise(double by) { height_ += scale_ * by; }
  /// Takes the true attitude at the end of a step of `dt` seconds; its height is not used.
  void lean(const Attitude& attitude, double dt);
  /// Begins again at `origin` of its frame, as after a restart of the driver. Its errors stay as they are.
  void reset(const Pose2& origin = {}) {
    pose_ = origin;
    height_ = 0.0;
    distance_ = turned_ = 0.0;
  }
  /// Above the start, m.
  double height() const { return height_; }
  /// Error of a flying body's height sensor now, m.
  double altimeter_error() const { return altimeter_; }
  /// Pose in the frame `odom`, which begins at the start pose.
  const Pose2& pose() const { return pose_; }
  /// Measured rotation from the body to `odom`, whose z axis is vertical.
  Eigen::Quaterniond orientation() const { return measured_.orientation(pose_.yaw); }
  /// Velocity as it was measured over the last step, body frame.
  const Twist2& twist() const { return twist_; }
  OdometrySigma sigma() const;

 private:
  double slip(double way);

  OdometryParams params_;
  Random random_;
  double scale_;
  double rate_;       ///< Rate of the heading error, rad/m.
  double turn_{1.0};  ///< Measured share of each turn.
  Random events_;     ///< For tilt and slip.
  Pose2 pose_{};
  double height_{};
  Twist2 twist_{};
  double roll_error_{}, pitch_error_{};  ///< rad
  double altimeter_{};                   ///< m
  Attitude measured_{};
  double slipping_{}, excess_{};  ///< What is left of a slip event, m; what it adds, share.
  double distance_{}, turned_{};  ///< Measured since the start, m and rad.
};

}  // namespace adit::sim
