// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <vector>

#include "core/config/platform.hpp"
#include "core/geometry/pose.hpp"

namespace adit::nav::test {

/// A world that is one height over each place, for terrain that boxes do not have: slopes, holes, gravel.
struct HeightWorld {
  static constexpr double kBottomless = -1e9;
  static constexpr double kHighest = 2.0;  ///< Above this height over the robot rays meet nothing, m.
  std::function<double(double, double)> ground;

  /// A spinning lidar of `rings` over +-15 degrees on a platform that stands at `body` (world): points in
  /// base_link, out to 12 m. `noise`: of the range, m (standard deviation).
  std::vector<Eigen::Vector3f> scan(const Platform& platform, const Pose3& body, int rings, int columns,
                                    double noise, std::mt19937& random) const {
    constexpr double kStride = 0.03, kFar = 12.0;
    std::normal_distribution<double> error(0.0, 1.0);
    std::vector<Eigen::Vector3f> points;
    points.reserve(static_cast<std::size_t>(rings) * static_cast<std::size_t>(columns));
    const Eigen::Vector3d lidar(0, 0, platform.lidar_height), from = body * lidar;
    for (int column = 0; column < columns; ++column)
      for (int ring = 0; ring < rings; ++ring) {
        const double bearing = 2 * M_PI * column / columns;
        const double elevation = rings == 1 ? 0.0 : (-15.0 + 30.0 * ring / (rings - 1)) * M_PI / 180.0;
        const Eigen::Vector3d local(std::cos(elevation) * std::cos(bearing),
                                    std::cos(elevation) * std::sin(bearing), std::sin(elevation));
        const Eigen::Vector3d direction = body.orientation * local;
        double range = 0.3;
        for (; range < kFar; range += kStride) {
          const Eigen::Vector3d at = from + range * direction;
          if (at.z() > body.position.z() + kHighest) break;
          const double above = at.z() - ground(at.x(), at.y());
          if (above > 0) continue;
          if (direction.z() < 0 && above > -kStride)
            range += std::max(above / -direction.z(), -kStride) * 0.5;
          points.push_back((lidar + local * (range + noise * error(random))).cast<float>());
          break;
        }
      }
    return points;
  }
};

}  // namespace adit::nav::test
