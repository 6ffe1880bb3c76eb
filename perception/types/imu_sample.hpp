// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>

namespace adit::perception {

/// One sample of an inertial measurement unit, in its own axes.
struct ImuSample {
  std::uint64_t stamp{};           ///< Driver's clock, ns.
  Eigen::Vector3d gyro{0, 0, 0};   ///< Angular velocity, rad/s.
  Eigen::Vector3d accel{0, 0, 0};  ///< Specific force, m/s2: upwards when at rest.
};

}  // namespace adit::perception
