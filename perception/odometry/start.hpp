// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <deque>
#include <optional>

#include "perception/types/body_motion.hpp"
#include "perception/types/imu_sample.hpp"

namespace adit::perception {

/// Attitude and gyro bias before the odometry begins, by the sensors of motion.
struct StartAttitude {
  Eigen::Quaterniond level_from_base{Eigen::Quaterniond::Identity()};  ///< Roll and pitch.
  Eigen::Vector3d gyro_bias{0, 0, 0};                                  ///< rad/s
  bool at_rest{};
};

/// Watches IMU and wheels until the body was at rest for long enough, or for too long was not.
class StartWatch {
 public:
  static constexpr std::uint64_t kRest = 500'000'000;        ///< ns
  static constexpr std::uint64_t kPatience = 2'000'000'000;  ///< ns

  void add(const ImuSample& sample);
  void add(const BodyMotion& sample);
  /// Roll, pitch and bias at `stamp`; nothing: wait.
  std::optional<StartAttitude> judge(std::uint64_t stamp) const;

 private:
  std::deque<ImuSample> imu_{};
  std::deque<BodyMotion> wheels_{};
  std::uint64_t first_{};
};

}  // namespace adit::perception
