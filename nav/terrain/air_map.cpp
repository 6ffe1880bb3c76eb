// SPDX-License-Identifier: Apache-2.0
#include "nav/terrain/air_map.hpp"

#include <algorithm>
#include <cmath>

namespace adit::nav {

AirMap::AirMap(const Platform& platform)
    : platform_(platform), body_(platform), grid_(static_cast<std::size_t>(kSide) * kSide) {
  cells_.reserve(kMax);
}

void AirMap::clear() {
  std::fill(grid_.begin(), grid_.end(), Cell{});
  cells_.clear();
}

void AirMap::add_scan(const ScanPoints& scan, const Pose3& body, double stamp_s) {
  constexpr double kMargin = 0.12;  // Free height required above and below the body, m.
  constexpr float kReach = 5.0f;    // Returns farther from the robot are ignored, m.
  constexpr float kOwn = 0.03f;     // Returns within this distance of the footprint belong to the robot, m.
  constexpr double kMemory = 0.7;   // A cell is kept for this long when the lidar should see it again, s.
  constexpr double kHiddenMemory = 8.0;  // The same for one above or below the rays or too near, s.
  constexpr float kShortest = 0.4f;      // The lidar may see nothing at shorter range, m.
  const auto low = static_cast<float>(-kMargin), high = static_cast<float>(platform_.height + kMargin);
  const Eigen::Vector3f lidar = scan.origin(platform_.lidar_origin()).cast<float>();
  float lowest = 0.0f, highest = 0.0f;  // Range of the slopes of the first lidar's rays.
  for (const Eigen::Vector3f& p : scan.first()) {
    const float range = std::hypot(p.x() - lidar.x(), p.y() - lidar.y());
    if (!(range > 0.1f && std::isfinite(p.z()))) continue;  // False when it is not a number.
    lowest = std::min(lowest, (p.z() - lidar.z()) / range);
    highest = std::max(highest, (p.z() - lidar.z()) / range);
  }
  for (const Eigen::Vector3f& p : scan.all()) {
    const float range = std::hypot(p.x(), p.y());
    if (!(range > 0.1f && std::isfinite(p.z()))) continue;  // False when it is not a number.
    if (range > kReach || p.z() < low || p.z() > high || body_.depth(p.x(), p.y()) > -kOwn) continue;
    const Eigen::Vector3d at = body * p.cast<double>();
    const auto i = static_cast<std::int32_t>(std::floor(at.x() / kCell));
    const auto j = static_cast<std::int32_t>(std::floor(at.y() / kCell));
    Cell& here = cell(i, j);
    if (here.scans == 0 || here.i != i || here.j != j) here = {i, j, static_cast<float>(at.z()), 0.0, 0};
    if (here.seen == stamp_s && here.scans > 0) {
      here.scans = kSure;  // Two returns in one scan.
      continue;
    }
    here.seen = stamp_s;
    here.z = static_cast<float>(at.z());
    here.scans = std::min<std::uint8_t>(kSure, here.scans + 1);
  }

  cells_.clear();
  const Pose3 back = body.inverse();
  for (Cell& each : grid_) {
    if (each.scans == 0) continue;
    const Eigen::Vector2f middle((static_cast<float>(each.i) + 0.5f) * kCell,
                                 (static_cast<float>(each.j) + 0.5f) * kCell);
    const Eigen::Vector3d local = back * Eigen::Vector3d(middle.x(), middle.y(), each.z);
    const auto range = static_cast<float>(std::hypot(local.x(), local.y()));
    const Eigen::Vector3f ray = local.cast<float>() - lidar;
    const float seen_range = ray.head<2>().norm(), rise = ray.z() / std::max(seen_range, 0.01f);
    const bool hidden = seen_range < kShortest || rise < lowest || rise > highest;
    const double age = stamp_s - each.seen;
    constexpr float kPassed = 0.2f;  // m: the robot has left the height of the cell since it was seen.
    const auto z = static_cast<float>(local.z());
    if (age > (hidden ? kHiddenMemory : kMemory) || range > kReach || z < low - kPassed ||
        z > high + kPassed) {
      each.scans = 0;
      continue;
    }
    if (each.scans >= kSure && cells_.size() < kMax) cells_.push_back(middle);
  }
}

}  // namespace adit::nav
