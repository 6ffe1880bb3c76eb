// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/bridge/attention.hpp"

#include <algorithm>
#include <map>

#include "basestation/gui/bridge/card.hpp"
#include "basestation/model/numbering.hpp"
#include "basestation/model/text.hpp"
#include "core/command/words.hpp"

namespace adit::gui {
namespace {

using station::Alert;

/// What happened, in a few words. Of a stop: who set it.
std::string what_of(const Alert& alert, const station::World& world) {
  std::vector<std::string> stoppers;
  if (alert.code == "stopped")
    for (const station::Robot& robot : world.robots)
      if (std::ranges::count(alert.robots, robot.name) > 0)
        for (const std::string& stopper : robot.stops)
          if (std::ranges::count(stoppers, stopper) == 0) stoppers.push_back(stopper);
  return stoppers.empty() ? station::code_text(alert.code) : "stopped by " + command::joined(stoppers, "");
}

/// The text of the notification names the operator who asked: "op2 asked for r3".
void offer_grant(Need& need, const Alert& alert, const station::World& world) {
  if (alert.code != "asked" || alert.robots.size() != 1) return;
  for (const station::StationSummary& station : world.stations)
    if (!station.self && !station.lost && alert.text.starts_with(station.name + " asked for ")) {
      constexpr std::size_t kLongName = 12;  // The text beside it names the operator, too.
      need.grant_label = station.name.size() > kLongName ? "Grant" : "Grant to " + station.name;
      need.grant_line = "grant " + alert.robots.front() + " " + station.name;
    }
}

using Numbers = std::map<std::string, int>;

/// The robots without their names: "robot 7", "4 robots".
std::string short_who(const std::vector<std::string>& robots, const Numbers& numbers) {
  if (robots.size() != 1) return robots.empty() ? "station" : std::to_string(robots.size()) + " robots";
  const auto found = numbers.find(robots.front());
  return found == numbers.end() ? "a robot" : "robot " + std::to_string(found->second);
}

Need need_of(const Alert& alert, const station::World& world, const Numbers& numbers, double now) {
  const bool act = alert.priority == station::Priority::act;
  constexpr std::size_t kShort = 45;  // Characters that have room at the top of the window.
  const std::string what = what_of(alert, world);
  const bool ends_when_seen = alert.ends == station::Ends::seen;
  Need need{.id = "alert " + std::to_string(alert.id),
            .robots = alert.robots,
            .who = alert.robots.empty() ? "station" : command::joined(alert.robots, ""),
            .short_who = short_who(alert.robots, numbers),
            .text = alert.text.empty() ? station::code_text(alert.code) : alert.text,
            .short_text = what.size() <= kShort ? what : station::code_text(alert.code),
            .since = age_text(now - alert.first),
            .urgent = act && !alert.seen,
            .can_see = !alert.seen && (act || ends_when_seen),
            .can_wait = !act && !ends_when_seen,
            .alert = alert.id};
  if (alert.robots.size() >= station::AlertQueue::kManyRobots) {
    need.who = std::to_string(alert.robots.size()) + " robots";
    need.text = what + ": " + command::joined(alert.robots, "");
  }
  if (alert.count > 1 && alert.robots.size() == 1)
    need.text += " (" + std::to_string(alert.count) + " times)";
  offer_grant(need, alert, world);
  return need;
}

}  // namespace

std::vector<Need> needs_of(const station::AlertQueue& queue, const station::World& world, double now) {
  Numbers numbers;
  const std::vector<int> in_order = station::numbers_of(world);
  for (std::size_t i = 0; i < in_order.size(); ++i) numbers[world.robots[i].name] = in_order[i];
  std::vector<Need> needs;
  for (const Alert& alert : queue.shown(now)) needs.push_back(need_of(alert, world, numbers, now));
  return needs;
}

}  // namespace adit::gui
