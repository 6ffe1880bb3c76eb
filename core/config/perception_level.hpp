// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

namespace adit {

/// What a robot computes from its sensors beside the scans for navigation. Key `perception` of a robot's file
/// and of a scenario.
enum class PerceptionLevel : std::uint8_t {
  off,       ///< The pose is the driver's odometry.
  odometry,  ///< The pose is that of the lidar-inertial odometry.
  slam,      ///< The same, and the robot builds a map that the stations receive.
};

/// The words for the levels in files and on command lines, in the order of PerceptionLevel.
inline const std::vector<std::string> kPerceptionWords{"off", "odometry", "slam"};

/// The level of one of kPerceptionWords.
inline PerceptionLevel perception_level(const std::string& word) {
  const auto found = std::find(kPerceptionWords.begin(), kPerceptionWords.end(), word);
  return static_cast<PerceptionLevel>(found - kPerceptionWords.begin());
}

/// How well a robot knows where it is. The values travel on the wire.
enum class Localisation : std::uint8_t {
  off = 0,       ///< The pose is the driver's odometry, which states no health.
  starting = 1,  ///< The odometry waits for sensors, or for the robot to be stationary.
  ok = 2,
  weak = 3,  ///< Lidar leaves a direction open, which wheels or inertia carry on.
  lost = 4,  ///< The lidar does not fit the map: only wheels or inertia carry the pose on.
};

constexpr const char* name(Localisation localisation) {
  switch (localisation) {
    case Localisation::off:
      return "off";
    case Localisation::starting:
      return "starting";
    case Localisation::ok:
      return "ok";
    case Localisation::weak:
      return "weak";
    case Localisation::lost:
      return "lost";
  }
  return "off";  // A value of another version.
}

}  // namespace adit
