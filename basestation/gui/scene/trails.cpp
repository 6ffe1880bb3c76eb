// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/scene/trails.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace adit::gui {

namespace {

/// Where a robot should be by its last state and velocity, and where it is, as a transform of the map.
struct Correction {
  double x{}, y{}, z{};  ///< Of the robot, m.
  double turn{};         ///< rad
  Point about{};         ///< The robot's expected place.

  Point apply(const Point& place, double share) const {
    const double angle = share * turn, c = std::cos(angle), s = std::sin(angle);
    const double dx = place.x - about.x, dy = place.y - about.y;
    return {about.x + c * dx - s * dy + share * x, about.y + s * dx + c * dy + share * y};
  }
};

Correction correction(const Trails::Motion& before, const station::Robot& now, double since) {
  const double yaw = before.yaw + before.wz * since / 2;
  const Point expected{before.x + since * (before.vx * std::cos(yaw) - before.vy * std::sin(yaw)),
                       before.y + since * (before.vx * std::sin(yaw) + before.vy * std::cos(yaw))};
  const double turned = now.yaw - before.yaw - before.wz * since;
  return {now.x - expected.x, now.y - expected.y, now.z - before.z,
          std::remainder(turned, 2.0 * std::numbers::pi), expected};
}

/// Moves a trail by a correction. The error grew along the way, so its share falls with the way back.
void move(std::deque<Trails::Stamped>& points, const Correction& by) {
  double length = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i)
    length +=
        std::hypot(points[i].place.x - points[i - 1].place.x, points[i].place.y - points[i - 1].place.y);
  double left = length;
  for (std::size_t i = points.size(); i-- > 0;) {
    const Point original = points[i].place;
    const double share = length > 0.0 ? left / length : 1.0;
    if (i > 0) left -= std::hypot(original.x - points[i - 1].place.x, original.y - points[i - 1].place.y);
    points[i].place = by.apply(original, share);
    points[i].z += share * by.z;
  }
}

/// The same, or none of it where a robot's values make no sense.
void correct(std::deque<Trails::Stamped>& points, const Correction& by) {
  const bool sane = drawable(by.about.x, by.about.y) && drawable(by.x, by.y) && std::isfinite(by.turn) &&
                    drawable(by.z, 0.0);
  if (sane)
    move(points, by);
  else
    points.clear();
}

}  // namespace

void Trails::add(const station::World& world, double now) {
  for (const station::Robot& robot : world.robots) {
    if (!robot.located || !drawable(robot.x, robot.y)) continue;
    Trail& trail = trails_[robot.name];
    const double state = now - std::max(robot.age, 0.0);
    const double since = state - trail.last_state;
    // Snapshots repeat a state whose age is rounded.
    constexpr double kComparable = 1.0;  // s: after a longer time the expected place means nothing.
    if (trail.last_state < 0.0 || since > 0.02) {
      if (trail.last_state >= 0.0 && robot.map_revision != trail.last.map_revision && since < kComparable)
        correct(trail.points, correction(trail.last, robot, since));
      trail.last = {robot.x, robot.y, robot.z, robot.yaw, robot.vx, robot.vy, robot.wz, robot.map_revision};
      if (trail.last_state >= 0.0 && since < 5.0) trail.period += 0.2 * (since - trail.period);
      trail.last_state = state;
    }
    const Point here{robot.x, robot.y};
    double moved = kJump;
    if (!trail.points.empty()) {
      const Point& last = trail.points.back().place;
      moved = std::hypot(here.x - last.x, here.y - last.y);
    }
    if (moved >= kStep) trail.points.push_back({here, now, trail.points.empty() || moved > kJump, robot.z});
    while (!trail.points.empty() &&
           (trail.points.size() > kMaxPoints || now - trail.points.front().time > kMaxAge))
      trail.points.pop_front();
  }
}

const Trails::Trail* Trails::of(const std::string& robot) const {
  const auto found = trails_.find(robot);
  return found == trails_.end() ? nullptr : &found->second;
}

double Trails::stale_after(const std::string& robot) const {
  const Trail* trail = of(robot);
  return std::max(1.0, trail ? 3.0 * trail->period : 0.0);
}

}  // namespace adit::gui
