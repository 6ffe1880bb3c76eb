// SPDX-License-Identifier: Apache-2.0
#include "sim/rehearsal/run_picture.hpp"

#include <algorithm>
#include <cstdio>

#include "sim/picture/picture.hpp"

namespace adit::sim {
namespace {

constexpr std::size_t kMaxEvents = 40;

Eigen::Vector2d position_at(const Trail& trail, Duration at) {
  if (trail.poses.empty()) return Eigen::Vector2d::Zero();
  const auto index = static_cast<std::size_t>(std::max<std::int64_t>(at / Trail::kPeriod - 1, 0));
  return trail.poses[std::min(index, trail.poses.size() - 1)].position();
}

std::string event_text(Duration at, const std::string& robot, const std::string& text) {
  char time[32];
  std::snprintf(time, sizeof time, "%6.1f s  ", seconds(at));
  return time + robot + "  " + text;
}

// Changes of mode are many and the trails show most of what they mean.
bool worth_drawing(const TimedEvent& event) {
  return event.text != "mode manual" && event.text != "mode hold" && event.text != "agent started" &&
         !event.text.starts_with("runs into ") && !event.text.starts_with("is touched by ");
}

}  // namespace

Result<void> draw_run(const Scenario& scenario, const World& world, const RunOutcome& outcome,
                      const std::filesystem::path& file) {
  PictureSpec spec;
  spec.title = scenario.name;
  char text[128];
  std::snprintf(text, sizeof text, "seed %llu, %.0f s over %s, %s",
                static_cast<unsigned long long>(outcome.report.seed), outcome.report.virtual_s,
                scenario.link.name.c_str(), outcome.report.ok() ? "all as expected" : "failed");
  spec.subtitle = text;
  for (const RobotStart& start : make_starts(scenario)) {
    const auto trail = outcome.trails.find(start.id);
    const auto robot = outcome.report.robots.find(start.id);
    if (trail == outcome.trails.end() || robot == outcome.report.robots.end()) continue;
    std::snprintf(text, sizeof text, "%s, %.1f m", start.platform.name.c_str(), robot->second.distance);
    spec.trails.push_back({start.id, text, trail->second.poses, start.platform.length, start.platform.width});
  }
  for (const Trail& person : outcome.people) spec.people.push_back({person.poses, Person::kSize});
  for (const Goal& goal : outcome.goals) spec.goals.push_back({goal.robot, goal.position});
  for (const Collision& collision : outcome.collisions) {
    if (spec.events.size() >= kMaxEvents / 2) break;
    spec.events.push_back({collision.pose.position(),
                           event_text(collision.at, collision.robot, "touched " + collision.partner)});
  }
  for (const TimedEvent& event : outcome.report.events) {
    const auto trail = outcome.trails.find(event.robot);
    if (spec.events.size() >= kMaxEvents || trail == outcome.trails.end() || !worth_drawing(event)) continue;
    spec.events.push_back(
        {position_at(trail->second, event.at), event_text(event.at, event.robot, event.text)});
  }
  return write_picture(world, spec, file);
}

}  // namespace adit::sim
