// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>

namespace adit::perception {

/// Compares the turns that the gyro measures with those of the odometry, to detect a gyro with the wrong sign
/// or unit.
///
/// Each quarter turn of the odometry gives one verdict. Slip makes the body turn less than the odometry says,
/// so only a turn in the opposite direction, or one that is many times larger, is an error.
class TurnCheck {
 public:
  /// One sample of the gyro: turn rate about z of base_link, rad/s. Stamps rise.
  void add_rate(std::uint64_t stamp, double rate);
  /// One sample of the odometry: its yaw, rad.
  void add_yaw(std::uint64_t stamp, double yaw);

  /// Gyro over odometry in the last quarter turn; 0: none was completed yet.
  double ratio() const { return ratio_; }
  /// Why the gyro cannot be right; empty while nothing is wrong.
  const std::string& refusal() const { return refusal_; }

 private:
  std::uint64_t rate_stamp_{}, yaw_stamp_{};
  double angle_{};       ///< Integral of the rate, rad.
  double yaw_{};         ///< Of the newest odometry, rad.
  double angle_then_{};  ///< `angle_` at `yaw_stamp_`.
  double turned_{};      ///< By the odometry since the last verdict, both directions counted positive, rad.
  double measured_{};    ///< The same turns by the gyro.
  double ratio_{};
  std::string refusal_{};
};

}  // namespace adit::perception
