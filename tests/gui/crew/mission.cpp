// SPDX-License-Identifier: Apache-2.0
#include "tests/gui/crew/mission.hpp"

#include <algorithm>
#include <numeric>
#include <sstream>

#include "core/time/random.hpp"

namespace adit::gui::crew {
namespace {

constexpr double kLane = 6.0;    // Between two galleries, m.
constexpr double kPillar = 0.6;  // Half of a side, m.

}  // namespace

const char* to_string(Event event) {
  switch (event) {
    case Event::blocked:
      return "blocked";
    case Event::stopped:
      return "stopped by op2";
    case Event::cut:
      return "link lost";
    case Event::hung:
      return "driver hung";
    case Event::handover:
      return "op2 asks for it";
  }
  return "?";
}

Place Mission::start(std::size_t robot) { return {0.0, kLane * static_cast<double>(robot)}; }

Mission Mission::draw(std::uint64_t seed, double length) {
  Random random(seed);
  Mission mission{.length = length};
  for (std::size_t robot = 0; robot < kRobots; ++robot)
    for (std::size_t goal = 0; goal < kGoals; ++goal) {
      const double off = 2.0 * random.uniform();
      mission.goals[robot][goal] = {goal % 2 == 0 ? length - off : off,
                                    start(robot).y + random.uniform() - 0.5};
    }
  std::array<std::size_t, kRobots> robots{};
  std::iota(robots.begin(), robots.end(), 0);
  for (std::size_t i = kRobots; i > 1; --i) std::swap(robots[i - 1], robots[random.below(i)]);
  constexpr std::array kEvents{Event::blocked,  Event::blocked, Event::stopped, Event::stopped,
                               Event::cut,      Event::cut,     Event::cut,     Event::hung,
                               Event::handover, Event::handover};
  for (std::size_t i = 0; i < kEvents.size(); ++i) {
    // A pillar stands where nothing was seen yet: at the first goal.
    const auto goal = kEvents[i] == Event::blocked ? 0 : static_cast<std::size_t>(random.below(kGoals));
    mission.interventions.push_back({robots[i], goal, kEvents[i], 2.0 + 3.0 * random.uniform()});
    // The pillar stays: later goals at that end keep away from it.
    if (kEvents[i] == Event::blocked)
      for (std::size_t later = 2; later < kGoals; later += 2)
        mission.goals[robots[i]][later] = {mission.goals[robots[i]][0].x - 4.0, start(robots[i]).y};
  }
  return mission;
}

const Intervention* Mission::intervention(std::size_t robot, std::size_t goal) const {
  const auto found = std::find_if(interventions.begin(), interventions.end(),
                                  [&](const Intervention& i) { return i.robot == robot && i.goal == goal; });
  return found == interventions.end() ? nullptr : &*found;
}

Place Mission::instead(std::size_t robot, std::size_t goal) const {
  return {goals[robot][goal].x - 3.0, start(robot).y};
}

std::string Mission::scenario(std::size_t robot) const {
  const double y = start(robot).y, end = length + 4.0;
  std::ostringstream out;
  const auto box = [&](double x0, double x1, double y0, double y1) {
    out << '[' << x0 << ", " << x1 << ", " << y0 << ", " << y1 << ", 0, 2.5]";
  };
  out << "world:\n  boxes: [";
  box(-2, end, y + 2, y + 2.2);
  out << ", ";
  box(-2, end, y - 2.2, y - 2);
  out << ", ";
  box(-2.2, -2, y - 2, y + 2);
  out << ", ";
  box(end, end + 0.2, y - 2, y + 2);
  for (const Intervention& i : interventions)
    if (i.robot == robot && i.event == Event::blocked) {
      const Place& goal = goals[robot][i.goal];
      out << ", ";
      box(goal.x - kPillar, goal.x + kPillar, goal.y - kPillar, goal.y + kPillar);
    }
  out << "]\n  floor: 0\n  ceiling: 2.5\nduration: 3600\nlink: wifi\nlidar: planar\nrobots:\n  - {id: "
      << name_of(robot) << ", platform: slow.yaml, pose: [0, " << y
      << ", 0]}\nbasestations:\n  - {id: op1, pose: [-1, 0]}\nscript: []\nexpect:\n  - {always: "
         "no_collision}\n";
  return out.str();
}

Step next_step(const Seen& seen) {
  if (seen.headline == "LOST" || seen.headline.empty() || seen.headline == "NOT HEARD YET") return Step::wait;
  if (seen.holder == "no holder") return Step::take;
  if (!seen.holder.starts_with("mine")) return Step::wait;
  if (seen.headline == "STOP") return Step::reset;
  if (seen.headline == "BLOCKED") return Step::another_way;
  if (seen.detail.starts_with("goal kept")) return Step::go_on;
  if (seen.detail == "arrived" || seen.detail == "ready") return Step::next_goal;
  return seen.holder == "mine" ? Step::lock : Step::wait;  // What drives is locked when there is time.
}

}  // namespace adit::gui::crew
