// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <string>

#include "core/config/sensors.hpp"
#include "core/result/result.hpp"
#include "perception/input/turn_check.hpp"
#include "perception/types/imu_sample.hpp"

namespace adit::perception {

/// Parameters of TiltFilter.
struct TiltFilterParams {
  double gain{0.3};        ///< Of the accelerometer, 1/s, (0, 10].
  double bias_gain{0.02};  ///< Of the gyro's bias, 1/s2, [0, gain^2 / 2].
  double start{0.5};       ///< The mean over so long is the first attitude, s, [0.1, 5].
  double gate{0.15};       ///< An acceleration that differs from gravity by more of it says nothing, (0, 1].
  double still{0.05};      ///< Slower, the body stands: m/s and rad/s, (0, 0.5].
  double steepest{0.873};  ///< A start on steeper ground is taken for a wrong mounting, rad, (0, 1.5].
};

/// Estimates roll and pitch of a body from its IMU: a complementary filter of gyro and accelerometer.
///
/// The state is the direction of gravity in `base_link` and the gyro's bias (Mahony, Hamel, Pflimlin:
/// *Nonlinear complementary filters on the special orthogonal group*, 2008, without the heading, which an
/// accelerometer does not show). From the specific force the acceleration that the odometry knows of is
/// subtracted: the derivative of the speed, the centripetal part and that of the lever arm. What differs from
/// gravity then says nothing.
class TiltFilter {
 public:
  explicit TiltFilter(const Mounting& mounting, const TiltFilterParams& params = {});

  /// One sample. Stamps rise; one that does not rise is left out. One that is older by more than a second is
  /// of a clock that was set back: the filter starts again.
  /// Errors: imu_mounting when gravity at rest is neither 9.81 m/s2 nor 1 g, or not up in `base_link`: the
  /// filter stays without an attitude; malformed for what is no number.
  Result<void> add(const ImuSample& sample);
  /// What the body drives by its odometry, body frame, m/s.
  void set_velocity(std::uint64_t stamp, const Eigen::Vector3d& velocity);
  /// Yaw of the body by its odometry, rad; the gyro must turn as it does.
  void set_yaw(std::uint64_t stamp, double yaw) { turns_.add_yaw(stamp, yaw); }

  /// R_level_base, without yaw, interpolated or held by at most 0.2 s. Errors: no_localisation while there is
  /// none, or none of then; imu_mounting with the text of the refusal, also when the gyro has the wrong sign
  /// or unit.
  Result<Eigen::Quaterniond> at(std::uint64_t stamp) const;
  /// Of the newest sample, ns; 0: none.
  std::uint64_t newest() const { return newest_; }
  /// The samples are in g, and are scaled.
  bool in_g() const { return scale_ != 1.0; }
  const Eigen::Vector3d& gyro_bias() const { return bias_; }
  const TurnCheck& turns() const { return turns_; }

 private:
  struct Entry {
    std::uint64_t stamp{};
    Eigen::Vector3d up{0, 0, 1};
  };
  static constexpr std::size_t kCapacity = 512;

  void restart();
  Result<void> start(std::uint64_t stamp, const Eigen::Vector3d& gyro, const Eigen::Vector3d& accel);
  void follow(double dt, const Eigen::Vector3d& gyro, const Eigen::Vector3d& accel);
  void keep(std::uint64_t stamp);
  /// The acceleration of the IMU that the odometry knows of, base_link, m/s2. `rate`: of the body, rad/s.
  Eigen::Vector3d driven(const Eigen::Vector3d& rate) const;
  const Entry& entry(std::size_t n) const { return entries_[(first_ + n) % kCapacity]; }

  TiltFilterParams params_;
  Eigen::Quaterniond R_base_imu_;
  Eigen::Vector3d lever_;  ///< The IMU in base_link, m.
  double scale_{1.0};      ///< From the sample's unit to m/s2.
  bool started_{false};
  std::string refusal_{};  ///< Why the IMU is not used.
  TurnCheck turns_{};
  Eigen::Vector3d up_{0, 0, 1}, bias_{0, 0, 0};
  Eigen::Vector3d velocity_{0, 0, 0}, acceleration_{0, 0, 0};
  std::uint64_t velocity_stamp_{0};
  // The samples of the start.
  std::uint64_t start_stamp_{0};
  Eigen::Vector3d accel_sum_{0, 0, 0}, gyro_sum_{0, 0, 0}, driven_sum_{0, 0, 0};
  std::size_t count_{0};
  std::uint64_t newest_{0};
  std::array<Entry, kCapacity> entries_{};
  std::size_t first_{0}, size_{0};
};

/// Roll and pitch, rad, of R_level_base.
Eigen::Vector2d roll_pitch(const Eigen::Quaterniond& R_level_base);
/// R_level_base without yaw: the smallest rotation that takes `up`, in base_link, upwards.
Eigen::Quaterniond level_from(const Eigen::Vector3d& up);

}  // namespace adit::perception
