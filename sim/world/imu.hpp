// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <optional>
#include <vector>

#include "core/geometry/pose.hpp"
#include "core/time/time.hpp"
#include "sim/world/noise.hpp"

namespace adit::sim {

/// How wrong an inertial sensor is. The defaults are a good MEMS sensor's.
struct ImuParams {
  double rate{100.0};           ///< Samples a second, Hz, [10, 400].
  double accel_noise{0.002};    ///< White noise density, m/s2/sqrt(Hz), [0, 1].
  double gyro_noise{0.0002};    ///< White noise density, rad/s/sqrt(Hz), [0, 1].
  double accel_bias{0.1};       ///< Largest bias at the start, m/s2, [0, 10].
  double gyro_bias{0.005};      ///< Largest bias at the start, rad/s, [0, 1].
  double accel_walk{2e-4};      ///< Random walk of the bias, m/s2/sqrt(s), [0, 1].
  double gyro_walk{2e-5};       ///< Random walk of the bias, rad/s/sqrt(s), [0, 1].
  double scale{0.003};          ///< Largest scale error of an axis, fraction, [0, 0.5].
  double misalignment{0.3};     ///< Largest angle of the axes to the nominal ones, degrees, [0, 10].
  double max_accel{156.9};      ///< Saturation of an axis (16 g), m/s2, (0, 1000].
  double max_gyro{34.9};        ///< Saturation of an axis (2000 degrees/s), rad/s, (0, 100].
  double accel_vibration{0.4};  ///< Of the drive at top speed, standard deviation, m/s2, [0, 20].
  double gyro_vibration{0.02};  ///< The same, rad/s, [0, 2].
  double gaps{0.002};           ///< Gaps a second, each up to 0.3 s long, 1/s, [0, 10].
  bool in_g{false};             ///< Says the specific force in g, a fault of the driver.
  bool upside_down{false};      ///< Mounted turned about its x axis, which the nominal mount does not say.
};

/// One measurement, in the sensor's own axes.
struct ImuSample {
  Duration at{};                                  ///< Time since the simulation's start.
  Eigen::Vector3d gyro{Eigen::Vector3d::Zero()};  ///< Angular velocity, rad/s.
  Eigen::Vector3d accel{
      Eigen::Vector3d::Zero()};  ///< Specific force, m/s2 (g where `in_g`): +g upwards at rest.
};

/// An inertial sensor on a moving body: angular velocity and specific force at its lever arm, by central
/// differences of the body's true poses, with the errors of `ImuParams`.
class Imu {
 public:
  /// `T_base_imu`: nominal mount. `noise` scales every error; 0 is the truth.
  Imu(const ImuParams& params, const Pose3& T_base_imu, double noise, std::uint64_t seed);

  /// Takes the body's true pose at `at`, one `step` after the last one. `effort`: share of the drive's top
  /// speed, [0, 1]. Gives samples up to one step earlier, as differences need the pose after them.
  void advance(const Pose3& T_world_base, Duration at, Duration step, double effort);
  /// Samples since the last call, oldest first; the newest kCapacity of them.
  std::vector<ImuSample> take();

  static constexpr std::size_t kCapacity = 400;
  const ImuParams& params() const { return params_; }

 private:
  struct Motion {
    Eigen::Vector3d gyro, accel;
  };
  /// Motion at the last but one pose.
  Motion motion(double dt) const;
  ImuSample measure(const Motion& true_motion, Duration at, double effort);
  Eigen::Vector3d vector(double deviation);

  ImuParams params_;
  double noise_;
  Random random_;
  Pose3 T_base_imu_;  ///< True.
  Eigen::Vector3d accel_bias_, gyro_bias_, accel_scale_, gyro_scale_;
  std::array<Pose3, 3> poses_{};  ///< Of the sensor in the world, the newest last.
  std::size_t known_{0};
  std::optional<Motion> before_{};
  Duration period_, next_{}, silent_until_{};
  std::vector<ImuSample> samples_{};
};

}  // namespace adit::sim
