// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace adit::perception {

/// One return of a lidar.
struct TimedPoint {
  Eigen::Vector3f position;  ///< In the lidar's frame, m; not finite where nothing was hit.
  float time;                ///< After Sweep::stamp, s; may be negative.
  float intensity;           ///< As the driver gives it; 0 without.
  std::uint16_t ring;        ///< Beam, from below or from above as the driver counts; 0 without.
};

/// One turn of a lidar, or what its driver sends at once.
struct Sweep {
  std::uint64_t stamp{};  ///< Of the message, driver's clock, ns.
  bool timed{false};      ///< Whether the points have times of their own.
  bool planar{false};     ///< Of a planar scanner, which may see nothing in the open.
  std::vector<TimedPoint> points{};
};

}  // namespace adit::perception
