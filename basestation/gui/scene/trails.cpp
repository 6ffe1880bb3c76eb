// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/scene/trails.hpp"

#include <algorithm>
#include <cmath>

namespace adit::gui {

void Trails::add(const station::World& world, double now) {
  for (const station::Robot& robot : world.robots) {
    if (!robot.located || !drawable(robot.x, robot.y)) continue;
    Trail& trail = trails_[robot.name];
    const double state = now - std::max(robot.age, 0.0);
    const double since = state - trail.last_state;
    // Snapshots repeat a state whose age is rounded.
    if (trail.last_state < 0.0 || since > 0.02) {
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
