// SPDX-License-Identifier: Apache-2.0
#include "nav/monitor/obstacle_detector.hpp"

#include <algorithm>
#include <cmath>

#include "core/config/traversability.hpp"

namespace adit::nav {

ObstacleDetector::ObstacleDetector(const Platform& platform, double reach)
    : near_(platform, reach), tracker_(platform), tilt_(Traversability::of(platform).tilt) {
  detected_.places.reserve(NearPoints::kMax);
  detected_.movers.reserve(Tracker::kMax);
}

const DetectedObstacles& ObstacleDetector::look(const ScanPoints& scan, const Pose3& body, double stamp_s) {
  constexpr double kUpright = 0.9;  // Fraction of the tilt limit below which a tilted body may drive again.
  tracker_.look(scan, body, stamp_s);
  near_.take(scan, body, stamp_s, tracker_.newest());
  detected_.places.assign(near_.places().begin(), near_.places().end());
  detected_.movers.assign(tracker_.movers().begin(), tracker_.movers().end());
  detected_.stamp_s = stamp_s;
  const Eigen::Vector3d up = body.orientation.conjugate() * Eigen::Vector3d::UnitZ();
  const double roll = std::fabs(std::atan2(up.y(), up.z()));
  const double pitch = std::fabs(std::asin(std::clamp(up.x(), -1.0, 1.0)));
  detected_.tilted = std::max(roll, pitch) > tilt_ * (detected_.tilted ? kUpright : 1.0);
  return detected_;
}

void ObstacleDetector::clear() {
  tracker_.clear();
  near_.clear();
  detected_.places.clear();
  detected_.movers.clear();
  detected_.tilted = false;
  detected_.stamp_s = -std::numeric_limits<double>::infinity();
}

}  // namespace adit::nav
