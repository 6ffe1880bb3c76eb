// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>

#include "nav/monitor/collision_monitor.hpp"

namespace adit::nav::test {

/// A collision monitor with its detector on the same thread.
class ScannedMonitor : public CollisionMonitor {
 public:
  explicit ScannedMonitor(const Platform& platform)
      : CollisionMonitor(platform), detector_(make_detector()) {}

  bool knows_movers{true};  ///< Else it takes everything to stand.

  void look(std::span<const Eigen::Vector3f> points, const Pose3& body, double stamp_s) {
    DetectedObstacles seen = detector_.look(points, body, stamp_s);
    if (!knows_movers) seen.movers.clear();
    see(std::make_shared<const DetectedObstacles>(std::move(seen)));
  }

 private:
  ObstacleDetector detector_;
};

}  // namespace adit::nav::test
