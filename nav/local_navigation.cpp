// SPDX-License-Identifier: Apache-2.0
#include "nav/local_navigation.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace adit::nav {

LocalNavigation::LocalNavigation(const Platform& platform, std::shared_ptr<const PlannerLibrary> library)
    : LocalNavigation(platform, [platform, library = std::move(library)] {
        return make_planner(platform, library).value();
      }) {}

LocalNavigation::LocalNavigation(const Platform& platform, PlannerFactory planner)
    : platform_(platform),
      make_planner_(std::move(planner)),
      terrain_(platform),
      tracker_(platform),
      planner_(make_planner_()),
      escape_(platform),
      way_back_(platform) {
  if (platform.flies()) air_.emplace(platform);
  constexpr std::size_t kMaxPredicted = 8192;  // Maximum number of predicted places of movers.
  obstacles_.reserve(std::max<std::size_t>(terrain_.max_places(), AirMap::kMax) + kMaxPredicted);
  moving_.reserve(Tracker::kMax * Mover::kMax);
}

void LocalNavigation::add_scan(const ScanPoints& scan, const LocalMapScan& at,
                               std::span<const Eigen::Vector3f> peers) {
  if (air_)
    air_->add_scan(scan, at.body, at.stamp_s);
  else
    terrain_.add_scan(scan, at.body, at.stamp_s);
  tracker_.look(scan, at.body, at.stamp_s);
  moving_.clear();
  for (const Mover& mover : tracker_.movers())
    if (mover.moves) moving_.insert(moving_.end(), mover.surface().begin(), mover.surface().end());
  const LocalMapOthers others{moving_, peers};
  map_ = air_ ? builder_.make(*air_, at, others) : builder_.make(terrain_, at, others);
}

Plan LocalNavigation::plan(const Target& target, const Pose2& pose, double stamp_s,
                           std::span<const Eigen::Vector2f> border, std::span<const Eigen::Vector3f> peers) {
  if (!map_) return {.stamp_s = stamp_s, .blocked = true};
  const IntoPose into(pose);
  obstacles_.clear();
  const auto add = [&](float x, float y, float cost) {
    const Eigen::Vector2f at = into(x, y);
    obstacles_.push_back({at.x(), at.y(), cost});
  };
  for (const LocalPlace& place : map_->places()) add(place.x, place.y, place.cost);
  Parts parts{obstacles_.size(), 0};
  for (const Eigen::Vector2f& place : border) add(place.x(), place.y(), 1.0f);
  parts.standing = obstacles_.size();
  const double moves = speed(pose, stamp_s);
  const double age = std::max(0.0, stamp_s - tracker_.stamp_s());
  predict(tracker_.movers(), age, pose, moves, platform_, obstacles_);
  Plan plan = plan_path(target, pose, stamp_s, parts);
  plan.stamp_s = stamp_s;
  constexpr float kBeforeOthers = 2.5f;  // So near to a peer a path must lead past it, m.
  const bool others = !peers.empty() || !tracker_.movers().empty();
  if (plan.blocked || (target.kind == Target::Kind::goal && others && !plan.arrived && !plan.nudge)) {
    const Hindrance found = hindrance(target, pose, parts, peers);
    // A path that does not lead past a robot of the team leads to and fro before it.
    const bool aside = !plan.blocked && !plan.ends_at_goal && found.cause == Cause::peer &&
                       found.along < kBeforeOthers && plan.reached < found.along;
    if (aside) plan = {.stamp_s = stamp_s, .blocked = true, .clearance = plan.clearance};
    if (plan.blocked || found.along < kBeforeOthers) {
      plan.cause = found.cause;
      plan.cause_ahead = found.along;
    }
  }
  plan.max_speed = std::min(plan.max_speed, speed_beside(tracker_.movers(), age, plan, platform_));
  return plan;
}

// Movers do not count for the way out of a narrow place: the robot waits for them.
Plan LocalNavigation::plan_path(const Target& target, const Pose2& pose, double stamp_s, const Parts& parts) {
  Plan plan;
  const auto standing = std::span(obstacles_).first(parts.standing);
  const auto nudge = [&] {
    const auto found = escape_.plan(pose, standing);
    if (found) plan = *found;
    plan.nudge = found.has_value();
    plan.blocked = !found;
    plan.side = escape_.side_of(standing);
  };
  if (target.kind == Target::Kind::back_up) {
    const auto found = way_back_.plan(pose, obstacles_);
    if (found) plan = *found;
    plan.blocked = !found;
  } else if (target.kind == Target::Kind::leave) {
    nudge();
  } else {
    plan = planner_->plan(target, pose, obstacles_, stamp_s);
    if (target.kind == Target::Kind::goal && !plan.blocked) way_back_.note(pose);
    if (!plan.blocked && target.kind == Target::Kind::goal && plan.pose_count > 1) {
      const Eigen::Vector2d way = target.goal - pose.position();
      const Eigen::Vector2d end = plan.path().back().position();
      plan.reached = std::max(0.0, (end - pose.position()).dot(way.normalized()));
      if (plan.ends_at_goal && !plan.reverse) plan.end_speed = target.end_speed;
    }
    if (!plan.blocked || target.kind != Target::Kind::goal) return plan;
    if (target.nudges) nudge();
  }
  return plan;
}

// What is nearest on the straight line to the target, which is about the route.
LocalNavigation::Hindrance LocalNavigation::hindrance(const Target& target, const Pose2& pose,
                                                      const Parts& parts,
                                                      std::span<const Eigen::Vector3f> peers) const {
  if (target.kind != Target::Kind::goal) return {};
  constexpr float kAhead = 4.0f, kBeside = 0.15f, kNear = 0.35f, kBesidePeer = 0.6f;  // m
  const Pose2 back = pose.inverse();
  const Eigen::Vector2f to = (back * target.goal).cast<float>();
  const float length = std::min(to.norm(), kAhead);
  const Eigen::Vector2f way = length > 1e-3f ? Eigen::Vector2f(to.normalized()) : Eigen::Vector2f(1, 0);
  const auto half = static_cast<float>(std::max(platform_.width, platform_.length) / 2) + kBeside;
  std::array<Eigen::Vector3f, 8> near_peers{};  // In the frame of the robot.
  std::size_t peer_count = 0;
  for (const Eigen::Vector3f& peer : peers) {
    const Eigen::Vector2f at = (back * Eigen::Vector2d(peer.x(), peer.y())).cast<float>();
    if (at.norm() < kAhead + peer.z() + half && peer_count < near_peers.size())
      near_peers[peer_count++] = {at.x(), at.y(), peer.z()};
  }
  float nearest = std::numeric_limits<float>::infinity(), nearest_peer = nearest;
  std::size_t what = 0;
  for (std::size_t n = 0; n < obstacles_.size(); ++n) {
    const ObstaclePoint& o = obstacles_[n];
    if (o.cost < 1.0f) continue;
    const float along = way.x() * o.x + way.y() * o.y, across = way.x() * o.y - way.y() * o.x;
    if (along < 0 || along > length + half || std::fabs(across) > half || along >= nearest + kBesidePeer)
      continue;
    for (std::size_t p = 0; p < peer_count; ++p)
      if (std::hypot(o.x - near_peers[p].x(), o.y - near_peers[p].y()) < near_peers[p].z() + kNear)
        nearest_peer = std::min(nearest_peer, along);
    if (along >= nearest) continue;
    nearest = along;
    what = n;
  }
  // A robot in a door stands beside the door's posts.
  if (std::isfinite(nearest_peer) && nearest_peer < nearest + kBesidePeer) return {Cause::peer, nearest_peer};
  if (!std::isfinite(nearest)) return {};
  const Eigen::Vector2f at = (pose * Eigen::Vector2d(obstacles_[what].x, obstacles_[what].y)).cast<float>();
  const bool moves =
      std::ranges::any_of(moving_, [&](const Eigen::Vector2f& place) { return (at - place).norm() < kNear; });
  if (moves || what >= parts.standing) return {Cause::mover, nearest};
  return {what >= parts.terrain ? Cause::border : Cause::fixed, nearest};
}

double LocalNavigation::speed(const Pose2& pose, double stamp_s) {
  constexpr double kShortest = 0.02, kLongest = 0.5;  // s: outside of this interval the speed is unknown.
  const double dt = stamp_s - last_stamp_s_, way = (pose.position() - last_pose_.position()).norm();
  last_pose_ = pose;
  last_stamp_s_ = stamp_s;
  return dt > kShortest && dt < kLongest ? std::min(way / dt, platform_.max_speed) : 0.0;
}

void LocalNavigation::clear() {
  terrain_.clear();
  if (air_) air_->clear();
  tracker_.clear();
  planner_ = make_planner_();
  way_back_.clear();
  map_.reset();
  last_stamp_s_ = -std::numeric_limits<double>::infinity();
}

}  // namespace adit::nav
