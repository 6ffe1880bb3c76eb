// SPDX-License-Identifier: Apache-2.0
#include "nav/routing/route_follower.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace adit::nav {
namespace {

constexpr double kSameGoal = 0.05;    // m
constexpr double kReachAhead = 0.9;   // m: a route that is blocked is blocked at this distance ahead.
constexpr double kSampling = 0.5;     // m
constexpr double kNextCorner = 5.0;   // m
constexpr double kSamePassage = 0.5;  // m: the estimated centre moves with the visible part of a passage.
// m before a passage: a robot that is blocked there is blocked by the passage.
constexpr double kAtPassage = 1.5;
constexpr double kBeyondPassage = 0.9;  // m behind its centre: the straight part ends here.
constexpr double kLeft = 0.6;           // m behind its centre: the route is free again.
constexpr double kReported = 3.0;       // m before a passage: it is reported to the planner from here on.
constexpr double kNear = 2.5;  // m: from nearer, only changes larger than the following replace a passage.
constexpr double kShifted = 0.10;  // m
constexpr double kTurned = 5.0 * M_PI / 180.0;
constexpr double kDetour = 1.03;  // A straight line may cost at most this factor of the route.

// The point of a polyline at a length from its beginning. `end`: the polyline is shorter.
Eigen::Vector3d point_at(const std::vector<Eigen::Vector3d>& points, double length, bool& end) {
  end = false;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const Eigen::Vector3d way = points[i + 1] - points[i];
    const double leg = way.norm();
    if (length < leg) return points[i] + way * (length / leg);
    length -= leg;
  }
  end = true;
  return points.back();
}

// Compares two places. A missing height (NaN) equals only another missing height.
bool same_place(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const bool level = std::isnan(a.z()) ? std::isnan(b.z()) : std::abs(a.z() - b.z()) <= kSameGoal;
  return level && (a - b).head<2>().norm() <= kSameGoal;
}

// The place on the axis of a passage at a distance behind its centre.
Eigen::Vector3d on_axis(const NarrowPassage& passage, double behind) {
  return {passage.middle.x() + behind * passage.axis.x(), passage.middle.y() + behind * passage.axis.y(),
          passage.middle.z()};
}

}  // namespace

// Shortens the route to the part from its point nearest to the robot. Only the first metres are searched, so
// a route that returns beside itself is not cut. Corners that the robot passed at a distance are dropped.
void RouteFollower::advance(RoutePlanner& planner, const Eigen::Vector3d& place) {
  auto& points = route_.points;
  double least = std::numeric_limits<double>::infinity(), passed = 0;
  std::size_t leg = 0;
  Eigen::Vector3d nearest = points.front();
  for (std::size_t i = 0; i + 1 < points.size() && passed < 5.0; ++i) {
    const Eigen::Vector3d way = points[i + 1] - points[i];
    const double length2 = way.head<2>().squaredNorm();
    const double t =
        length2 > 0 ? std::clamp((place - points[i]).head<2>().dot(way.head<2>()) / length2, 0.0, 1.0) : 0.0;
    const Eigen::Vector3d p = points[i] + t * way;
    if (const double d = (p - place).head<2>().norm(); d < least - 1e-6) {
      least = d;
      leg = i;
      nearest = p;
    }
    passed += way.norm();
  }
  points.erase(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(leg));
  points.front() = {place.x(), place.y(), nearest.z()};
  while (points.size() > 2 && (points[1] - points[0]).norm() < kNextCorner) {
    const LineEnds goal{.relax_end = points.size() == 3};
    const LineCost direct =
        planner.line(points[0], points[2], {.relax_start = true, .relax_end = goal.relax_end});
    const double round = planner.line(points[0], points[1], {.relax_start = true}).cost +
                         planner.line(points[1], points[2], goal).cost;
    if (!direct.passable || direct.cost > round) break;
    points.erase(points.begin() + 1);
  }
}

void RouteFollower::watch_blocked(RoutePlanner& planner, const Eigen::Vector3d& place, bool blocked,
                                  double stamp_s) {
  if (!blocked || !route_.found()) {
    blocked_since_.reset();
    return;
  }
  if (!blocked_since_) blocked_since_ = stamp_s;
  if (stamp_s - *blocked_since_ < params_.blocked || stamp_s < retry_until_) return;
  blocked_since_.reset();
  if (approached_passage_ && !has_failed(*approached_passage_)) {
    // The robot has time to back up and try again.
    failed_passage_ = approached_passage_;
    retry_until_ = stamp_s + params_.retry;
    return;
  }
  failed_passage_.reset();  // The next approach may line up again.
  bool end = false;
  const Eigen::Vector3d there = point_at(route_.points, kReachAhead, end);
  if (!end) planner.block({there.x(), there.y(), place.z()}, stamp_s);
}

// Cost of the first `length` metres of the route.
double RouteFollower::cost_to(RoutePlanner& planner, double length) const {
  double cost = 0;
  for (std::size_t i = 0; i + 1 < route_.points.size() && length > 0; ++i) {
    const Eigen::Vector3d way = route_.points[i + 1] - route_.points[i];
    const double leg = way.norm(), share = leg > length ? length / leg : 1.0;
    cost += planner
                .line(route_.points[i], route_.points[i] + share * way,
                      {.relax_start = i == 0, .relax_end = i + 2 == route_.points.size()})
                .cost;
    length -= leg;
  }
  return cost;
}

bool RouteFollower::has_failed(const Eigen::Vector3d& passage) const {
  return failed_passage_ && (*failed_passage_ - passage).norm() < kSamePassage;
}

// Whether the robot has not left the passage yet, and the route still leads through it.
bool RouteFollower::leads_through(const NarrowPassage& passage, const Eigen::Vector3d& place) const {
  if ((place - passage.middle).head<2>().dot(passage.axis) > kLeft) return false;
  double passed = 0;
  for (std::size_t i = 0; i + 1 < route_.points.size() && passed < kReported + kSamePassage; ++i) {
    const Eigen::Vector2d way = (route_.points[i + 1] - route_.points[i]).head<2>();
    const Eigen::Vector2d to = (passage.middle - route_.points[i]).head<2>();
    const double length2 = way.squaredNorm();
    const double t = length2 > 0 ? std::clamp(to.dot(way) / length2, 0.0, 1.0) : 0.0;
    if ((to - t * way).norm() < kSamePassage && way.dot(passage.axis) > 0) return true;
    passed += way.norm();
  }
  return false;
}

// Updates the passage that the robot is in or approaches. A passage seen from near is fixed unless it turns
// out to be clearly elsewhere: a target that moves with each scan would keep the robot turning before it.
void RouteFollower::watch_passage(RoutePlanner& planner, const Eigen::Vector3d& place) {
  if (passage_ && !leads_through(*passage_, place)) {
    if (has_failed(passage_->middle)) failed_passage_.reset();
    passage_.reset();
  }
  const auto seen = planner.passage(route_.points, kReported);
  if (!seen || !planner.line(seen->middle, on_axis(*seen, kBeyondPassage), {.relax_start = true}).passable)
    return;
  const bool same = passage_ && (passage_->middle - seen->middle).head<2>().norm() < kSamePassage;
  // The robot must leave its passage before the next one counts.
  if (passage_ && !same &&
      (passage_->middle - place).head<2>().norm() < (seen->middle - place).head<2>().norm())
    return;
  if (same && frozen_) {
    const Eigen::Vector2d off = (seen->middle - passage_->middle).head<2>();
    const double aside = std::abs(passage_->axis.x() * off.y() - passage_->axis.y() * off.x());
    if (aside < kShifted && passage_->axis.dot(seen->axis) > std::cos(kTurned)) return;
  }
  if (!same && failed_passage_ && !has_failed(seen->middle)) {
    failed_passage_.reset();
    retry_until_ = -std::numeric_limits<double>::infinity();
  }
  passage_ = seen;
  frozen_ = (seen->middle - place).head<2>().norm() < kNear;
}

// Computes the farthest point of the route, up to `ahead`, with a straight line to it that keeps the same
// clearance as the route.
RouteStep RouteFollower::along(RoutePlanner& planner, const Eigen::Vector3d& place) {
  approached_passage_.reset();
  RouteStep step{RouteStep::State::along, {}, false};
  if (params_.passages) watch_passage(planner, place);
  if (passage_) {
    const Eigen::Vector2d rest = (passage_->middle - place).head<2>();
    if (rest.norm() < kAtPassage && rest.dot(passage_->axis) > 0) approached_passage_ = passage_->middle;
    step.target = on_axis(*passage_, kBeyondPassage);
    step.passage = passage_;
    return step;
  }
  const Eigen::Vector3d from{place.x(), place.y(), route_.points.front().z()};
  for (double ahead = params_.ahead; ahead >= params_.least_ahead; ahead -= kSampling) {
    step.target = point_at(route_.points, ahead, step.last);
    const LineCost direct = planner.line(from, step.target, {.relax_start = true, .relax_end = step.last});
    if (direct.passable && direct.cost <= kDetour * cost_to(planner, ahead) + kRouteCell) return step;
  }
  step.target = point_at(route_.points, params_.least_ahead, step.last);
  return step;
}

RouteStep RouteFollower::step(RoutePlanner& planner, const Eigen::Vector3d& place,
                              const Eigen::Vector3d& goal, bool blocked, double stamp_s) {
  if (!goal_ || !same_place(*goal_, goal)) {
    clear();
    goal_ = goal;
  }
  if (planner.map().used() == 0) return {RouteStep::State::straight, goal, true};
  bool usable = route_.found(), longer = false;
  if (usable) advance(planner, place);
  watch_blocked(planner, place, blocked, stamp_s);
  const bool lost = usable && !planner.measure(route_);
  usable = usable && !lost;
  if (lost || !looked_ || stamp_s - *looked_ >= params_.look) {
    looked_ = stamp_s;
    Route other = planner.plan(place, goal);
    const bool better =
        other.cost < route_.cost * params_.switch_ratio && other.cost < route_.cost - params_.gain;
    if (!usable || (other.found() && better)) {
      longer = other.found() && other.length > route_.length + params_.gain;
      route_ = std::move(other);
    }
  }
  if (route_.found()) {
    unreachable_since_.reset();
    RouteStep step = along(planner, place);
    double left = 0;
    for (std::size_t i = 0; i + 1 < route_.points.size(); ++i)
      left += (route_.points[i + 1] - route_.points[i]).norm();
    step.length = left;
    step.stuck = progress_.stuck(left, longer, stamp_s);
    return step;
  }
  if (route_.status != RouteStatus::unreachable) return {RouteStep::State::straight, goal, true};
  if (planner.has_blocked_places()) return {RouteStep::State::blocked, goal, true};
  if (!unreachable_since_) unreachable_since_ = stamp_s;
  if (stamp_s - *unreachable_since_ < params_.proof) return {RouteStep::State::blocked, goal, true};
  return {RouteStep::State::unreachable, goal, true};
}

}  // namespace adit::nav
