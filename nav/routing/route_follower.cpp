// SPDX-License-Identifier: Apache-2.0
#include "nav/routing/route_follower.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "nav/geometry/segment.hpp"

namespace adit::nav {
namespace {

/// Replaces the route only if the new cost is below this fraction of the current one.
constexpr double kSwitchRatio = 0.85;
constexpr double kLookPeriod = 0.5;     // Of the search for a better route, s.
constexpr double kGain = 0.5;           // Required gain of a new route, m.
constexpr double kFarthestAhead = 4.0;  // Distance along the route to the local planner's target, m.
constexpr double kProof = 2.0;          // A goal is unreachable after failing for this long, s.
constexpr double kCuts = 0.3;           // A corner is cut by so much, m.
constexpr double kBrakingShare = 0.7;   // Fraction of the platform's acceleration used for planned braking.
// Speed at a goal that the robot passes, m/s: what lies behind may be hidden.
constexpr double kPassing = 0.6;
constexpr double kMoved = 0.05;       // m: a goal that moved by more has another route.
constexpr double kReachAhead = 0.9;   // m: without a passage, a blocked route is blocked so far ahead.
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
// rad: greatest turn that the local planner drives itself.
constexpr double kOneCorner = 110.0 * M_PI / 180.0;
constexpr double kRoomy = 1.3;    // A metre of a route with room costs at most this, m.
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

// The place on the axis of a passage at a distance behind its centre.
Eigen::Vector3d on_axis(const NarrowPassage& passage, double behind) {
  return {passage.middle.x() + behind * passage.axis.x(), passage.middle.y() + behind * passage.axis.y(),
          passage.middle.z()};
}

// Whether the route changes the floor in unseen space, also straight up in one place.
bool changes_floor_unseen(const Route& route) {
  double rise = 0.0;
  for (std::size_t i = 0; i + 1 < route.points.size(); ++i) {
    const Eigen::Vector3d way = route.points[i + 1] - route.points[i];
    const bool unseen = (i < route.unknown.size() && route.unknown[i]) || way.head<2>().norm() < kRouteCell;
    if (unseen) rise += std::abs(way.z());
  }
  return rise > 1.0;
}

}  // namespace

Target target_of(const RouteStep& step) {
  if (step.state != RouteStep::State::along) return {};
  Target target = Target::to(step.target.head<2>());
  target.route = step.route;
  target.last = step.last;
  target.end_speed = step.end_speed;
  if (!step.last) target.tolerance = RouteStep::kTolerance;
  if (step.passage)
    target.passage = {step.passage->middle.x(), step.passage->middle.y(),
                      std::atan2(step.passage->axis.y(), step.passage->axis.x())};
  return target;
}

RecoveryInput recovery_input(const RouteStep& step) {
  return {.route = step.route,
          .left = step.length,
          .unreachable = step.state == RouteStep::State::unreachable,
          .start_blocked = step.state == RouteStep::State::start_blocked};
}

// Shortens the route to the part from its point nearest to the robot. Only the first metres are searched, so
// a route that returns beside itself is not cut. Corners that the robot passed at a distance are dropped.
void RouteFollower::advance(RoutePlanner& planner, const Eigen::Vector3d& place) {
  auto& points = route_.points;
  double least = std::numeric_limits<double>::infinity(), passed = 0;
  std::size_t leg = 0;
  Eigen::Vector3d nearest = points.front();
  for (std::size_t i = 0; i + 1 < points.size() && passed < 5.0; ++i) {
    const Eigen::Vector3d way = points[i + 1] - points[i];
    const double t = part_before(place.head<2>(), points[i].head<2>(), points[i + 1].head<2>());
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

// Marks what blocks the route, which the scans do not show, and looks for another one. Where only another
// way would help, and there is none, nothing is marked.
void RouteFollower::look_around(RoutePlanner& planner, const RouteRequest& request) {
  bool end = false;
  const double ahead = std::max(kReachAhead, request.blocked_ahead);
  Eigen::Vector3d there = point_at(route_.points, ahead, end);
  const Eigen::Vector2d to = passage_ ? (passage_->middle - request.place).head<2>() : Eigen::Vector2d(0, 0);
  // An obstacle well behind the passage does not close it.
  const bool in_passage = to.norm() < std::max(kAtPassage, ahead) && ahead < to.norm() + kBeyondPassage;
  if (passage_ && in_passage && to.dot(passage_->axis) > 0) {
    there = passage_->middle;
    end = false;
  }
  if (end) return;
  planner.map().block(there, request.stamp_s);
  Route other = planner.plan(request.place, request.goal);
  if (!other.found() && request.ask == RouteAsk::around_if_found) return planner.map().unblock_last();
  passage_.reset();
  take(std::move(other), false);
}

void RouteFollower::take(Route route, bool same) {
  route_ = std::move(route);
  if (route_.found() && !same) ++number_;
}

// A way up that was not seen is a guess. While the route consists of that guess, and stairs lead there that
// are closed to the body, it is worth as many metres as a goal that was not seen (`--budget` of goto). Height
// that was gained proves a ramp.
std::optional<Staircase> RouteFollower::give_up_search(RoutePlanner& planner, const RouteRequest& request) {
  constexpr double kMinSearch = 20.0, kDetour = 1.5;  // m, times the straight line.
  constexpr double kGained = 0.5;  // m: more than the error of heights, less than half a storey.
  const double height = std::abs(request.goal.z() - request.place.z());
  const bool guesses = std::isfinite(height) && height > kSameStorey && changes_floor_unseen(route_) &&
                       planner.has_closed_stairs(request.goal.z());
  if (!guesses) {
    search_.reset();
    return std::nullopt;
  }
  const Eigen::Vector2d at = request.place.head<2>();
  if (!search_ || height < search_->height - kGained)
    search_ = Search{at, std::max(kMinSearch, kDetour * (request.goal.head<2>() - at).norm()), height};
  // Noise of a stationary robot's odometry counts no metres.
  if (const double step = (at - search_->at).norm(); step >= kRouteCell) {
    search_->left -= step;
    search_->at = at;
  }
  if (search_->left > 0.0) return std::nullopt;
  // No staircase that the robot can reach leads there: the guess may be right.
  const auto stairs = planner.closed_stairs(request.place, request.goal);
  if (!stairs) search_.reset();
  return stairs;
}

void RouteFollower::clear() {
  route_ = {};
  search_.reset();
  goal_id_.reset();
  unreachable_since_.reset();
  looked_.reset();
  passage_.reset();
  frozen_ = false;
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

// Whether the robot has not left the passage yet, and the route still leads through it.
bool RouteFollower::leads_through(const NarrowPassage& passage, const Eigen::Vector3d& place) const {
  if ((place - passage.middle).head<2>().dot(passage.axis) > kLeft) return false;
  double passed = 0;
  for (std::size_t i = 0; i + 1 < route_.points.size() && passed < kReported + kSamePassage; ++i) {
    const Eigen::Vector2d way = (route_.points[i + 1] - route_.points[i]).head<2>();
    const Eigen::Vector2d to = (passage.middle - route_.points[i]).head<2>();
    const double t =
        part_before(passage.middle.head<2>(), route_.points[i].head<2>(), route_.points[i + 1].head<2>());
    if ((to - t * way).norm() < kSamePassage && way.dot(passage.axis) > 0) return true;
    passed += way.norm();
  }
  return false;
}

// Updates the passage that the robot is in or approaches. A passage seen from near is fixed unless it turns
// out to be clearly elsewhere: a target that moves with each scan would keep the robot turning before it.
void RouteFollower::watch_passage(RoutePlanner& planner, const Eigen::Vector3d& place) {
  if (passage_ && !leads_through(*passage_, place)) passage_.reset();
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
  passage_ = seen;
  frozen_ = (seen->middle - place).head<2>().norm() < kNear;
}

// The distance of a target to which no straight line leads. With room, the local planner drives round a
// corner by itself, wider and faster than to a target in the corner; but not round two.
double RouteFollower::least_ahead(RoutePlanner& planner) const {
  double length = 0, turned = 0;
  for (std::size_t i = 0; i + 1 < route_.points.size() && length < sweeping_ahead_; ++i) {
    const Eigen::Vector2d leg = (route_.points[i + 1] - route_.points[i]).head<2>();
    if (i > 0) {
      const Eigen::Vector2d before = (route_.points[i] - route_.points[i - 1]).head<2>();
      turned += std::fabs(std::atan2(before.x() * leg.y() - before.y() * leg.x(), before.dot(leg)));
    }
    if (turned > kOneCorner) break;
    length += leg.norm();
  }
  if (length < sweeping_ahead_) return kLeastAhead;
  length = sweeping_ahead_;
  const bool roomy = cost_to(planner, length) <= kRoomy * length + kRouteCell;
  return roomy ? length : kLeastAhead;
}

// Computes the farthest point of the route, up to `ahead`, with a straight line to it that keeps the same
// clearance as the route.
RouteStep RouteFollower::along(RoutePlanner& planner, const Eigen::Vector3d& place) {
  RouteStep step{.state = RouteStep::State::along, .route = number_, .last = false};
  if (passages_) watch_passage(planner, place);
  if (passage_) {
    step.target = on_axis(*passage_, kBeyondPassage);
    step.passage = passage_;
    return step;
  }
  const Eigen::Vector3d from{place.x(), place.y(), route_.points.front().z()};
  const double least = least_ahead(planner);
  for (double ahead = kFarthestAhead; ahead >= least; ahead -= kSampling) {
    step.target = point_at(route_.points, ahead, step.last);
    const LineCost direct = planner.line(from, step.target, {.relax_start = true, .relax_end = step.last});
    if (direct.passable && direct.cost <= kDetour * cost_to(planner, ahead) + kRouteCell) return step;
  }
  step.target = point_at(route_.points, least, step.last);
  return step;
}

// The speed at the target from which the robot can still drive round the next corners and stop at the goal.
// A corner of angle a that is cut by c has the radius c cos(a/2) / (1 - cos(a/2)).
double RouteFollower::end_speed(const RouteStep& step, const Eigen::Vector3d& place, bool pass) const {
  const double braking = 2 * kBrakingShare * max_acceleration_;
  const double at_goal = pass ? kPassing : 0.0;
  if (step.last) return std::min(at_goal, max_speed_);
  // The route behind the target, which lies beside it: from the corner after the nearest place on it.
  std::size_t after = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < route_.points.size() && i < RouteStep::kMaxAhead; ++i) {
    const Eigen::Vector2d way = (route_.points[i + 1] - route_.points[i]).head<2>();
    const Eigen::Vector2d to = (step.target - route_.points[i]).head<2>();
    const double t =
        part_before(step.target.head<2>(), route_.points[i].head<2>(), route_.points[i + 1].head<2>());
    if (const double d = (to - t * way).norm(); d < least - 1e-6) {
      least = d;
      after = i + 1;
    }
  }
  std::vector<Eigen::Vector2d> corners{place.head<2>(), step.target.head<2>()};
  for (std::size_t i = after; i < route_.points.size() && corners.size() < RouteStep::kMaxAhead; ++i)
    if ((route_.points[i].head<2>() - corners.back()).norm() > kRouteCell)
      corners.push_back(route_.points[i].head<2>());
  double squared = corners.size() < RouteStep::kMaxAhead ? at_goal * at_goal : 0.0;
  for (std::size_t i = corners.size() - 1; i-- > 1;) {
    const Eigen::Vector2d in = corners[i] - corners[i - 1], out = corners[i + 1] - corners[i];
    squared += braking * out.norm();
    if (in.norm() < kRouteCell) continue;
    const double cosine = std::clamp(in.dot(out) / (in.norm() * out.norm()), -1.0, 1.0);
    const double half = std::sqrt((1 + cosine) / 2);  // Cosine of half the angle.
    if (half > 1 - 1e-6) continue;
    const double fastest = 0.8 * max_turn_ * kCuts * half / (1 - half);
    squared = std::min(squared, fastest * fastest);
  }
  return std::min(std::sqrt(squared), max_speed_);
}

void RouteFollower::add_ahead(RouteStep& step) const {
  step.corners = route_.points.size();
  for (std::size_t i = 0; i + 1 < step.corners; ++i)
    step.length += (route_.points[i + 1] - route_.points[i]).norm();
  const std::size_t count = std::min(step.corners, RouteStep::kMaxAhead);
  step.ahead.assign(route_.points.begin(), route_.points.begin() + static_cast<std::ptrdiff_t>(count));
  // The beginning of a route is dropped before the rest is measured again.
  if (route_.unknown.size() + 1 < step.corners) return;
  const std::size_t dropped = route_.unknown.size() + 1 - step.corners;
  for (std::size_t leg = 0; leg + 1 < count; ++leg)
    if (route_.unknown[leg + dropped]) step.unknown_ahead |= 1U << leg;
}

RouteStep RouteFollower::step(RoutePlanner& planner, const RouteRequest& request) {
  const Eigen::Vector3d& place = request.place;
  const bool level = std::isnan(goal_.z()) == std::isnan(request.goal.z()) &&
                     !(std::abs(goal_.z() - request.goal.z()) > kMoved);
  const bool moved = goal_id_ && (!level || (goal_ - request.goal).head<2>().norm() > kMoved);
  if (!goal_id_ || *goal_id_ != request.goal_id) clear();
  if (!goal_id_) goal_ = request.goal;
  goal_id_ = request.goal_id;
  const bool open = request.ask == RouteAsk::open, asked = request.ask != RouteAsk::none && !open;
  if (planner.map().used() == 0) return {.replanned = asked};
  if (open) {
    planner.map().unblock();
    looked_.reset();
  }
  if (route_.found()) {
    advance(planner, place);
    if (asked) look_around(planner, request);
  }
  // A route through unseen space may climb where the ground does not: the robot is below or above it then.
  const bool off =
      route_.found() && std::abs(route_.points.front().z() - place.z()) > double{kFloorSeparation};
  const bool lost = route_.found() && (!planner.measure(route_) || off);
  const bool usable = route_.found() && !lost;
  if (lost || moved || !looked_ || request.stamp_s - *looked_ >= kLookPeriod) {
    looked_ = request.stamp_s;
    Route other = planner.plan(place, request.goal);
    const bool better = other.cost < route_.cost * kSwitchRatio && other.cost < route_.cost - kGain;
    if (other.found()) goal_ = request.goal;
    if (!usable || (other.found() && (better || moved)))
      take(std::move(other), route_.found() && !better && std::fabs(other.length - route_.length) < kGain);
  }
  RouteStep step{};
  if (route_.found()) {
    unreachable_since_.reset();
    if (const auto stairs = give_up_search(planner, request)) {
      step = {.state = RouteStep::State::unreachable, .goal = Standing::over_stairs, .stairs = stairs};
    } else {
      step = along(planner, place);
      step.end_speed = end_speed(step, place, request.pass);
      add_ahead(step);
    }
  } else if (route_.status == RouteStatus::start_blocked) {
    step.state = RouteStep::State::start_blocked;
  } else if (planner.map().has_blocked_places()) {
    step.state = RouteStep::State::blocked;
  } else {
    if (!unreachable_since_) unreachable_since_ = request.stamp_s;
    if (request.stamp_s - *unreachable_since_ >= kProof) step.state = RouteStep::State::unreachable;
    if (route_.stairs) step.goal = Standing::over_stairs;
    step.stairs = route_.stairs;
  }
  step.replanned = asked;
  return step;
}

}  // namespace adit::nav
