// SPDX-License-Identifier: Apache-2.0
#include "nav/terrain/air_map.hpp"

#include <algorithm>
#include <cmath>

namespace adit::nav {

AirMap::AirMap(const Platform& platform, const AirMapParams& params)
    : platform_(platform), params_(params), body_(platform), grid_(static_cast<std::size_t>(kSide) * kSide) {
  cells_.reserve(kMax);
}

void AirMap::clear() {
  std::fill(grid_.begin(), grid_.end(), Cell{});
  cells_.clear();
}

void AirMap::add_scan(const ScanPoints& scan, const Pose3& body, double stamp_s) {
  const auto low = static_cast<float>(-params_.margin);
  const auto high = static_cast<float>(platform_.height + params_.margin);
  const auto reach = static_cast<float>(params_.reach), own = static_cast<float>(-params_.own);
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
    if (range > reach || p.z() < low || p.z() > high || body_.depth(p.x(), p.y()) > own) continue;
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
    const bool hidden = seen_range < static_cast<float>(params_.shortest) || rise < lowest || rise > highest;
    const double age = stamp_s - each.seen;
    constexpr float kPassed = 0.2f;  // m: the robot has left the height of the cell since it was seen.
    const auto z = static_cast<float>(local.z());
    if (age > (hidden ? params_.hidden_memory : params_.memory) || range > reach || z < low - kPassed ||
        z > high + kPassed) {
      each.scans = 0;
      continue;
    }
    if (each.scans >= kSure && cells_.size() < kMax) cells_.push_back(middle);
  }
}

}  // namespace adit::nav
