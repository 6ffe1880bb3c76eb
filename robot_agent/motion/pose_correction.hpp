// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>

#include "core/config/perception_level.hpp"
#include "core/geometry/pose.hpp"
#include "core/time/time.hpp"

namespace adit::agent {

/// The result of the robot's own odometry for one scan.
struct OdometryReport {
  std::uint64_t stamp{};     ///< End of the sweep, driver's clock, ns.
  Pose3 T_local_driver{};    ///< The driver's odometry in the frame of this odometry.
  std::uint32_t instance{};  ///< Of the odometry: another one has another frame.
  Localisation health{Localisation::starting};
  double sigma{};  ///< Standard deviation of the horizontal position since the odometry began, m.
};

/// Places the driver's odometry in the frame `odom`, as the robot's own odometry says.
///
/// The driver's odometry carries the pose between two scans, and goes on alone when the own odometry is
/// silent: so the pose has the driver's rate and delay, and never jumps. A correction is applied at no more
/// than a walking pace, for the same reason. Where the driver's frame began again, or another instance of the
/// odometry begins, the next report continues from the present pose.
class PoseCorrection {
 public:
  static constexpr double kMaxSpeed = 0.5;  ///< Of the correction, m/s.
  static constexpr double kMaxTurn = 0.5;   ///< rad/s
  static constexpr Duration kSilence = 1s;  ///< After a longer silence the health is `starting`.

  /// Continues with a stored correction after a restart.
  void restore(const Pose3& T_odom_driver) { T_odom_driver_ = wanted_ = T_odom_driver; }
  /// The driver's frame began again; reports about scans before `stamp` are of the previous one.
  void begin_frame(std::uint64_t stamp);
  /// Moves the pose by `correction` in odom, as it was found by other means; level.
  void shift(const Pose3& correction);
  /// Takes a report. Ignored: one that is not finite, or of a previous frame.
  void take(const OdometryReport& report, Time now);
  /// T_odom_base for a pose of the driver.
  Pose3 apply(const Pose3& T_driver_base, std::uint64_t stamp);

  const Pose3& T_odom_driver() const { return T_odom_driver_; }
  Localisation health(Time now) const;
  double sigma() const { return sigma_; }

 private:
  Pose3 T_odom_driver_{}, wanted_{};
  std::optional<Pose3> T_odom_local_{};  ///< Nothing: the next report sets it.
  std::uint32_t instance_{};
  std::uint64_t frame_began_{}, applied_{};
  std::optional<Pose3> T_driver_base_{};  ///< The newest one.
  std::optional<Time> heard_{};
  Localisation health_{Localisation::starting};
  double sigma_{}, sigma_before_{};  ///< In m; the latter is of earlier instances.
};

}  // namespace adit::agent
