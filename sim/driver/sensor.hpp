// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

namespace adit::sim {

/// A sensor of a simulated driver.
enum class Sensor { lidar, odometry, imu };

/// By Sensor, as they are written in a scenario.
inline const std::vector<std::string>& sensor_words() {
  static const std::vector<std::string> words{"lidar", "odometry", "imu"};
  return words;
}

}  // namespace adit::sim
