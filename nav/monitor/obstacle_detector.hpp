// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <limits>
#include <vector>

#include "core/geometry/scan_points.hpp"
#include "nav/monitor/near_points.hpp"
#include "nav/tracking/tracker.hpp"

namespace adit::nav {

/// What one scan shows around the body, as a value that another thread may read: the obstacles and movers by
/// which CollisionMonitor judges velocities. Odometry frame.
struct DetectedObstacles {
  std::vector<NearPoints::Place> places{};  ///< At most NearPoints::kMax.
  std::vector<Mover> movers{};              ///< At most Tracker::kMax, at the time of the scan.
  bool tilted{false};                       ///< The body tilts so far that it may tip over.
  double stamp_s{-std::numeric_limits<double>::infinity()};  ///< Time of the scan, s.
};

/// Detects the obstacles and movers of each scan around the body, with the memory that this needs: the range
/// images of the last second, tracks, and places that the newest scan cannot show. A scan takes time in
/// proportion to its points, 6 to 40 ms for 262 000, which is why it is not part of CollisionMonitor: the
/// strand that checks velocities has no time for it.
class ObstacleDetector {
 public:
  /// `reach`: radius around base_link in which obstacles count, m, (0, 4].
  ObstacleDetector(const Platform& platform, double reach);

  /// Takes the newest scan; pose of the body in the odometry frame; time of arrival,
  /// s, not decreasing. The result is valid until the next call. Nothing is allocated after the first calls.
  const DetectedObstacles& look(const ScanPoints& scan, const Pose3& body, double stamp_s);
  /// Forgets all scans, for example after a jump of the odometry.
  void clear();

 private:
  NearPoints near_;
  Tracker tracker_;
  double tilt_;  ///< Roll or pitch at which the body may tip over, rad.
  DetectedObstacles detected_{};
};

}  // namespace adit::nav
