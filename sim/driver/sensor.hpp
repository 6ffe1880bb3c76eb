// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <string>
#include <vector>

namespace adit::sim {

/// A sensor of a simulated driver; `camera`: all cameras of the robot.
enum class Sensor { lidar, odometry, imu, camera };
inline constexpr std::size_t kSensors = 4;

/// By Sensor, as they are written in a scenario.
inline const std::vector<std::string>& sensor_words() {
  static const std::vector<std::string> words{"lidar", "odometry", "imu", "camera"};
  return words;
}

}  // namespace adit::sim
