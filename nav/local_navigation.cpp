// SPDX-License-Identifier: Apache-2.0
#include "nav/local_navigation.hpp"

#include <algorithm>
#include <cmath>

namespace adit::nav {
namespace {

constexpr std::size_t kMaxPredicted = 8192;  ///< Maximum number of predicted places of movers.

}  // namespace

LocalNavigation::LocalNavigation(const Platform& platform, const TerrainParams& terrain,
                                 const FalcoPlannerParams& planner,
                                 std::shared_ptr<const PlannerLibrary> library)
    : LocalNavigation(platform, terrain, [platform, planner, library = std::move(library)] {
        return make_planner(platform, planner, library).value();
      }) {}

LocalNavigation::LocalNavigation(const Platform& platform, const TerrainParams& terrain,
                                 PlannerFactory planner)
    : platform_(platform),
      make_planner_(std::move(planner)),
      terrain_(platform, terrain),
      tracker_(platform),
      planner_(make_planner_()),
      escape_(platform) {
  if (platform.flies()) air_.emplace(platform);
  obstacles_.reserve(std::max<std::size_t>(terrain_.max_cells(), AirMap::kMax) + kMaxPredicted);
}

void LocalNavigation::add_scan(const ScanPoints& scan, const Pose3& body, double stamp_s) {
  if (air_)
    air_->add_scan(scan, body, stamp_s);
  else
    terrain_.add_scan(scan, body, stamp_s);
  tracker_.look(scan, body, stamp_s);
  has_scan_ = true;
}

Plan LocalNavigation::plan(const Target& target, const Pose2& pose, double stamp_s,
                           std::span<const Eigen::Vector2f> border) {
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
  const auto add = [&](float x, float y, float cost) {
    const float dx = x - x0, dy = y - y0;
    obstacles_.push_back({c * dx + s * dy, c * dy - s * dx, cost});
  };
  if (air_)
    for (const Eigen::Vector2f& cell : air_->cells()) add(cell.x(), cell.y(), 1.0f);
  else
    for (const TerrainCell& cell : terrain_.cells()) add(cell.x, cell.y, cell.cost);
  for (const Eigen::Vector2f& place : border) add(place.x(), place.y(), 1.0f);
  const std::size_t standing = obstacles_.size();
  const double moves = speed(pose, stamp_s);
  const double age = std::max(0.0, stamp_s - tracker_.stamp_s());
  predict(tracker_.movers(), age, pose, moves, platform_, obstacles_);
  Plan plan = planner_->plan(target, pose, obstacles_, stamp_s);
  if ((plan.blocked || target.held) && target.kind == Target::Kind::goal) {
    // Movers do not count: the robot waits for them.
    const auto out = escape_.plan(pose, std::span(obstacles_).first(standing));
    if (plan.blocked && out) {
      const double clearance = plan.clearance;
      plan = *out;
      plan.stamp_s = stamp_s;
      plan.clearance = clearance;
    } else if (plan.blocked && escape_.side() != Side::none) {
      plan.reason = Reason::start_in_collision;
    }
    // The collision monitor may block a motion that the planner permits.
    if (target.held || plan.blocked) plan.side = escape_.side();
  }
  plan.max_speed = std::min(plan.max_speed, speed_beside(tracker_.movers(), age, plan, platform_));
  return plan;
}

double LocalNavigation::speed(const Pose2& pose, double stamp_s) {
  constexpr double kShortest = 0.02, kLongest = 0.5;  // s: outside of this interval the speed is unknown.
  const double dt = stamp_s - last_stamp_s_, way = (pose.position() - last_pose_.position()).norm();
  last_pose_ = pose;
  last_stamp_s_ = stamp_s;
  return dt > kShortest && dt < kLongest ? std::min(way / dt, platform_.max_speed) : 0.0;
}

void LocalNavigation::blocked(std::vector<Eigen::Vector2f>& cells) const {
  cells.clear();
  if (air_) {
    cells.assign(air_->cells().begin(), air_->cells().end());
    return;
  }
  for (const TerrainCell& cell : terrain_.cells())
    if (cell.cost >= 1.0f) cells.emplace_back(cell.x, cell.y);
}

void LocalNavigation::clear() {
  terrain_.clear();
  if (air_) air_->clear();
  tracker_.clear();
  planner_ = make_planner_();
  has_scan_ = false;
  last_stamp_s_ = -std::numeric_limits<double>::infinity();
}

}  // namespace adit::nav
