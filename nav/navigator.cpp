#include "nav/navigator.hpp"

namespace adit::nav {

Navigator::Navigator(const Platform& platform, const ObstacleMapParams& map,
                     const LocalPlannerParams& planner, std::shared_ptr<const PlannerLibrary> library)
    : map_(platform, map), planner_(platform, planner, std::move(library)) {}

void Navigator::add_scan(std::span<const Eigen::Vector3f> points, const Pose3& body, double stamp_s) {
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
  return planner_.plan(target, pose, map_.cells(), stamp_s);
}

void Navigator::clear() {
  map_.clear();
  has_scan_ = false;
}

}  // namespace adit::nav
