#include "nav/route/route_keeper.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace adit::nav {
namespace {

constexpr double kSameGoal = 0.05;   // m
constexpr double kReachAhead = 0.9;  // m: a route that is blocked is so this far ahead
constexpr double kSampling = 0.5;    // m
constexpr double kNextCorner = 5.0;  // m
constexpr double kInGate = 0.3;      // m before its middle
constexpr double kBeforeGate = 1.1;  // m: there the robot lines up
constexpr double kBack = 0.3;        // m: so much nearer it does not go back there unless it is well off
constexpr double kSameGate = 0.5;    // m: its middle wanders with what was seen of it
constexpr double kAtGate = 1.5;      // m: from farther off no path of the local planner leads through
constexpr double kBeyondGate = 0.9;  // m: so far it goes straight on
constexpr double kEnters = 0.6;      // m before its middle a robot that is lined up is in it
constexpr double kLeft = 0.6;        // m behind its middle it has left it
constexpr double kThere = 0.1;       // m from where it lines up: nearer no planner comes
constexpr double kAside = 0.25;      // m: farther off its axis a robot is not in it
constexpr double kLinedUp = 0.10;    // tangent of the angle off the gate's axis
constexpr double kStaysLinedUp = 0.25;
constexpr double kTold = 3.0;     // m before it a gap is told to who finds its own way
constexpr double kDetour = 1.03;  // a straight line that costs more than this much of the route is none

// The point of a way at a length from its beginning, and whether that is its end.
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

// A height that is not given is a place of its own.
bool same_place(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const bool level = std::isnan(a.z()) ? std::isnan(b.z()) : std::abs(a.z() - b.z()) <= kSameGoal;
  return level && (a - b).head<2>().norm() <= kSameGoal;
}

// A place on the axis of a gate, so far behind its middle.
Eigen::Vector3d on_axis(const Gate& gate, double behind) {
  return {gate.middle.x() + behind * gate.axis.x(), gate.middle.y() + behind * gate.axis.y(),
          gate.middle.z()};
}

}  // namespace

// The route from the point of it that is nearest, over the first metres: a way that comes back beside
// itself is not cut. A corner that was passed at some distance is none any more.
void RouteKeeper::advance(RoutePlanner& planner, const Eigen::Vector3d& place) {
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
    const LineEnds goal{.let_in = points.size() == 3};
    const LineCost direct = planner.line(points[0], points[2], {.let_out = true, .let_in = goal.let_in});
    const double round = planner.line(points[0], points[1], {.let_out = true}).cost +
                         planner.line(points[1], points[2], goal).cost;
    if (!direct.passable || direct.cost > round) break;
    points.erase(points.begin() + 1);
  }
}

void RouteKeeper::watch_blocked(RoutePlanner& planner, const Eigen::Vector3d& place, bool blocked,
                                double stamp_s) {
  if (!blocked || !route_.found()) {
    blocked_since_.reset();
    return;
  }
  if (!blocked_since_) blocked_since_ = stamp_s;
  if (stamp_s - *blocked_since_ < params_.blocked || stamp_s < retry_until_) return;
  blocked_since_.reset();
  if (lines_up_for_ && !is_waived(*lines_up_for_)) {
    // It goes on from where it is. Who finds its own way has the time to back off and try again.
    waived_ = lines_up_for_;
    if (params_.gates == GateUse::tell) retry_until_ = stamp_s + params_.retry;
    return;
  }
  waived_.reset();  // whoever comes again may line up
  bool end = false;
  const Eigen::Vector3d there = point_at(route_.points, kReachAhead, end);
  if (!end) planner.block({there.x(), there.y(), place.z()}, stamp_s);
}

// Of the route's first part, which ends at a length from its beginning.
double RouteKeeper::cost_to(RoutePlanner& planner, double length) const {
  double cost = 0;
  for (std::size_t i = 0; i + 1 < route_.points.size() && length > 0; ++i) {
    const Eigen::Vector3d way = route_.points[i + 1] - route_.points[i];
    const double leg = way.norm(), share = leg > length ? length / leg : 1.0;
    cost += planner
                .line(route_.points[i], route_.points[i] + share * way,
                      {.let_out = i == 0, .let_in = i + 2 == route_.points.size()})
                .cost;
    length -= leg;
  }
  return cost;
}

bool RouteKeeper::is_waived(const Eigen::Vector3d& gate) const {
  return waived_ && (*waived_ - gate).norm() < kSameGate;
}

// In a gate there is no room to turn: until the robot has left it, it goes straight on, as long as the route
// still leads that way.
std::optional<Eigen::Vector3d> RouteKeeper::straight_on(const Eigen::Vector3d& place) {
  if (!inside_) return std::nullopt;
  const Eigen::Vector2d past = place.head<2>() - inside_->middle.head<2>();
  const double along = past.dot(inside_->axis);
  const double aside = std::abs(inside_->axis.x() * past.y() - inside_->axis.y() * past.x());
  bool end = false;
  const Eigen::Vector2d next = point_at(route_.points, kBeyondGate, end).head<2>() - place.head<2>();
  if (along < -kBeforeGate || along > kLeft || aside > kAside || next.dot(inside_->axis) <= 0) {
    inside_.reset();
    lined_up_ = false;
    if (along > kLeft) waived_.reset();
    return std::nullopt;
  }
  return on_axis(*inside_, kBeyondGate);
}

// The gate that it is in; else the next one.
bool RouteKeeper::tell_gate(RoutePlanner& planner, const Eigen::Vector3d& place) {
  if (straight_on(place)) return true;
  inside_ = planner.gate(route_.points, kTold);
  if (inside_ && !planner.line(inside_->middle, on_axis(*inside_, kBeyondGate), {.let_out = true}).passable)
    inside_.reset();
  if (inside_ && waived_ && !is_waived(inside_->middle)) {
    waived_.reset();
    retry_until_ = -std::numeric_limits<double>::infinity();
  }
  return inside_.has_value();
}

// A robot that is to go through a gate lines up before it, and goes straight on behind it.
std::optional<Eigen::Vector3d> RouteKeeper::gate_step(RoutePlanner& planner, const Eigen::Vector3d& place) {
  if (const auto on = straight_on(place)) return on;
  const auto gate = planner.gate(route_.points, params_.ahead);
  const Eigen::Vector2d rest =
      gate ? Eigen::Vector2d(gate->middle.head<2>() - place.head<2>()) : Eigen::Vector2d(0, 0);
  const double before = gate ? rest.dot(gate->axis) : 0.0;
  if (before < kInGate) {
    lined_up_ = false;
    return std::nullopt;
  }
  const double off = std::abs(gate->axis.x() * rest.y() - gate->axis.y() * rest.x()) / before;
  double s = kBeforeGate;
  while (s > kInGate && !planner.line(on_axis(*gate, -s), gate->middle, {.let_in = true}).passable)
    s -= kRouteCell;
  // Nobody goes back for a little.
  const bool past = lined_up_ || before < s - kBack, at_gate = rest.norm() < kAtGate;
  lined_up_ = before < kAtGate && off < (past ? kStaysLinedUp : kLinedUp);
  if (!lined_up_ && !(at_gate && is_waived(gate->middle))) {
    if (s <= kInGate) return std::nullopt;
    const Eigen::Vector3d here = on_axis(*gate, -s);
    if ((here - place).head<2>().norm() > kThere) {
      if (at_gate) lines_up_for_ = gate->middle;
      return here;
    }
    lined_up_ = true;
  }
  const Eigen::Vector3d beyond = on_axis(*gate, kBeyondGate);
  if (!planner.line(gate->middle, beyond, {.let_out = true}).passable) return std::nullopt;
  if (before < kEnters) inside_ = gate;
  return beyond;
}

// The farthest point of the route, up to `ahead`, that is in a straight line from here: one that keeps as far
// from what stands there as the route does.
RouteStep RouteKeeper::along(RoutePlanner& planner, const Eigen::Vector3d& place) {
  lines_up_for_.reset();
  RouteStep step{RouteStep::State::along, {}, false};
  if (const auto target =
          params_.gates == GateUse::line_up ? gate_step(planner, place) : std::optional<Eigen::Vector3d>{}) {
    step.target = *target;
    return step;
  }
  if (params_.gates == GateUse::tell && tell_gate(planner, place)) {
    const Eigen::Vector2d rest = (inside_->middle - place).head<2>();
    if (rest.norm() < kAtGate && rest.dot(inside_->axis) > 0) lines_up_for_ = inside_->middle;
    step.target = on_axis(*inside_, kBeyondGate);
    step.gate = inside_;
    return step;
  }
  const Eigen::Vector3d from{place.x(), place.y(), route_.points.front().z()};
  for (double ahead = params_.ahead; ahead >= params_.least_ahead; ahead -= kSampling) {
    step.target = point_at(route_.points, ahead, step.last);
    const LineCost direct = planner.line(from, step.target, {.let_out = true, .let_in = step.last});
    if (direct.passable && direct.cost <= kDetour * cost_to(planner, ahead) + kRouteCell) return step;
  }
  step.target = point_at(route_.points, params_.least_ahead, step.last);
  return step;
}

RouteStep RouteKeeper::step(RoutePlanner& planner, const Eigen::Vector3d& place, const Eigen::Vector3d& goal,
                            bool blocked, double stamp_s) {
  if (!goal_ || !same_place(*goal_, goal)) {
    clear();
    goal_ = goal;
  }
  if (planner.map().used() == 0) return {RouteStep::State::straight, goal, true};
  bool kept = route_.found();
  if (kept) advance(planner, place);
  watch_blocked(planner, place, blocked, stamp_s);
  // A doubtful route is none to the map as it is: it is driven along until the next look.
  const bool lost = kept && !route_.doubtful && !planner.measure(route_);
  kept = kept && !lost && !route_.doubtful;
  if (lost || !looked_ || stamp_s - *looked_ >= params_.look) {
    looked_ = stamp_s;
    Route other = planner.plan(place, goal);
    const bool better =
        other.cost < route_.cost * params_.momentum && other.cost < route_.cost - params_.gain;
    if (!kept || (other.found() && better)) route_ = std::move(other);
  }
  if (route_.found()) {
    lost_since_.reset();
    return along(planner, place);
  }
  if (route_.status != RouteStatus::unreachable) return {RouteStep::State::straight, goal, true};
  if (planner.has_blocked_places()) return {RouteStep::State::blocked, goal, true};
  if (!lost_since_) lost_since_ = stamp_s;
  if (stamp_s - *lost_since_ < params_.proof) return {RouteStep::State::blocked, goal, true};
  return {RouteStep::State::unreachable, goal, true};
}

}  // namespace adit::nav
