#include "nav/navigator.hpp"

#include <algorithm>
#include <cmath>

namespace adit::nav {

Navigator::Navigator(const Platform& platform, const ObstacleMapParams& map,
                     const LocalPlannerParams& planner, std::shared_ptr<const PlannerLibrary> library)
    : map_(platform, map), planner_(make_planner(platform, planner, std::move(library)).value()) {
  if (platform.flies()) air_.emplace(platform);
  obstacles_.reserve(std::max<std::size_t>(ObstacleMap::kMaxCells, AirMap::kMost));
}

void Navigator::add_scan(std::span<const Eigen::Vector3f> points, const Pose3& body, double stamp_s) {
  if (air_)
    air_->add_scan(points, body, stamp_s);
  else
    map_.add_scan(points, body, stamp_s);
  has_scan_ = true;
}

Plan Navigator::plan(const Target& target, const Pose2& pose, double stamp_s) {
  if (!has_scan_) {
    Plan plan;
    plan.stamp_s = stamp_s;
    plan.blocked = true;
    plan.reason = Reason::terrain_stale;
    return plan;
  }
  const auto c = static_cast<float>(std::cos(pose.yaw)), s = static_cast<float>(std::sin(pose.yaw));
  const auto x0 = static_cast<float>(pose.x), y0 = static_cast<float>(pose.y);
  obstacles_.clear();
  for (const Eigen::Vector2f& cell : cells()) {
    const float dx = cell.x() - x0, dy = cell.y() - y0;
    obstacles_.push_back({c * dx + s * dy, c * dy - s * dx, 1.0f});
  }
  return planner_->plan(target, pose, obstacles_, stamp_s);
}

void Navigator::clear() {
  map_.clear();
  if (air_) air_->clear();
  has_scan_ = false;
}

}  // namespace adit::nav
