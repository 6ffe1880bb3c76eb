// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>

#include "nav/monitor/collision_monitor.hpp"

namespace adit::nav::test {

/// A collision monitor with its detector on the same thread.
class ScannedMonitor : public CollisionMonitor {
 public:
  explicit ScannedMonitor(const Platform& platform, const CollisionMonitorParams& params = {})
      : CollisionMonitor(platform, params), detector_(make_detector()) {}

  void look(std::span<const Eigen::Vector3f> points, const Pose3& body, double stamp_s) {
    see(std::make_shared<const DetectedObstacles>(detector_.look(points, body, stamp_s)));
  }

 private:
  ObstacleDetector detector_;
};

}  // namespace adit::nav::test
