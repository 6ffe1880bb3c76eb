// SPDX-License-Identifier: Apache-2.0
#include "sim/rehearsal/random_script.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace adit::sim {
namespace {

constexpr std::array kVerbs{"take", "release", "lock", "unlock", "grant",   "goto",  "drive",
                            "stop", "reset",   "mode", "convoy", "peeloff", "yield", "area"};

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f", value);
  return text;
}

const std::string& pick(const std::vector<std::string>& from, Random& random) {
  return from[random.below(from.size())];
}

/// A place within reach of the robot's start, world frame, m.
Eigen::Vector2d draw_place(const RandomScript& spec, const Scenario& scenario, const std::string& robot,
                           Random& random) {
  const RobotSpec* start = scenario.robot(robot);
  const Pose2 pose = start ? start->pose : Pose2{};
  const double x = pose.x + random.uniform(-spec.reach.x(), spec.reach.x());
  return {x, pose.y + random.uniform(-spec.reach.y(), spec.reach.y())};
}

/// Adds, replaces or removes one of two areas of the robot.
std::string draw_area(const RandomScript& spec, const Scenario& scenario, const std::string& robot,
                      Random& random) {
  const std::string name = random.chance(0.5) ? "near" : "far";
  if (random.chance(0.25)) return "area " + robot + " remove " + name;
  const bool inside = random.chance(0.2);
  const Eigen::Vector2d middle = draw_place(spec, scenario, robot, random);
  const double largest = inside ? 8.0 : 1.5, smallest = inside ? 3.0 : 0.3;
  const double length = random.uniform(smallest, largest), width = random.uniform(smallest, largest);
  const Eigen::Vector2d half(length, width);
  const Eigen::Vector2d low = middle - half, high = middle + half;
  return "area " + robot + " add " + name + (inside ? " keep_in " : " keep_out ") + number(low.x()) + " " +
         number(low.y()) + " " + number(high.x()) + " " + number(high.y());
}

std::string draw_command(const RandomScript& spec, const Scenario& scenario, const std::string& by,
                         const std::string& robot, Random& random) {
  const std::string& verb = pick(spec.verbs, random);
  const std::string head = verb + " " + robot;
  if (verb == "grant") {
    // Mostly another operator of the list, now and then himself.
    std::string to = pick(spec.by, random);
    if (to == by) to = pick(spec.by, random);
    return head + " " + to;
  }
  if (verb == "goto") {
    const Eigen::Vector2d place = draw_place(spec, scenario, robot, random);
    return head + " " + number(place.x()) + " " + number(place.y());
  }
  if (verb == "drive")
    return head + " " + number(random.uniform(-0.5, 1.0)) + " 0 " + number(random.uniform(-0.8, 0.8)) +
           " --for " + number(random.uniform(0.3, 2.0));
  if (verb == "convoy") {
    const double kind = random.uniform(0.0, 1.0);
    if (kind < 0.2) return "convoy stop " + robot;
    if (kind < 0.4) return "mode " + robot + " convoy_follow";
    std::string followers;
    for (const std::string& other : spec.robots)
      if (other != robot && (followers.empty() || random.chance(0.5))) followers += " " + other;
    return followers.empty() ? "convoy stop " + robot : "convoy start " + robot + followers;
  }
  if (verb == "area") return draw_area(spec, scenario, robot, random);
  if (verb == "yield") return head + (random.chance(0.7) ? " on" : " off");
  if (verb == "reset") return random.chance(0.4) ? head + " --override" : head;
  if (verb == "mode") {
    static constexpr std::array modes{"hold", "waypoint", "manual", "smart_joystick", "explore"};
    return head + " " + modes[random.below(modes.size())];
  }
  return head;
}

}  // namespace

bool is_random_verb(const std::string& verb) {
  return std::find(kVerbs.begin(), kVerbs.end(), verb) != kVerbs.end();
}

std::vector<std::string> all_random_verbs() { return {kVerbs.begin(), kVerbs.end()}; }

std::vector<ScriptLine> draw_script(const RandomScript& spec, const Scenario& scenario, Random random) {
  std::vector<ScriptLine> lines;
  std::string robot = pick(spec.robots, random);
  for (int i = 0; i < spec.commands; ++i) {
    // In whole milliseconds: as a scenario file says it, and as it is read from there.
    const double at_s = random.uniform(seconds(spec.from), seconds(spec.to));
    const Duration at = from_seconds(std::round(at_s * 1000.0) / 1000.0);
    const std::string by = pick(spec.by, random);
    if (!random.chance(0.25)) robot = pick(spec.robots, random);
    lines.push_back({at, by, draw_command(spec, scenario, by, robot, random)});
  }
  std::stable_sort(lines.begin(), lines.end(), [](const auto& a, const auto& b) { return a.at < b.at; });
  return lines;
}

}  // namespace adit::sim
