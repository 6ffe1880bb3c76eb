// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/bridge/attention.hpp"

#include <algorithm>

#include "basestation/gui/bridge/card.hpp"
#include "core/command/words.hpp"

namespace adit::gui {
namespace {

using station::Alert;

std::string spaced(std::string code) {
  std::replace(code.begin(), code.end(), '_', ' ');
  return code;
}

/// The text of the notification names the operator who asked: "op2 asked for r3".
void offer_grant(Need& need, const Alert& alert, const station::World& world) {
  if (alert.code != "asked" || alert.robots.size() != 1) return;
  for (const station::StationSummary& station : world.stations)
    if (!station.self && !station.lost && alert.text.starts_with(station.name + " asked for ")) {
      need.grant_label = "Grant to " + station.name;
      need.grant_line = "grant " + alert.robots.front() + " " + station.name;
    }
}

Need need_of(const Alert& alert, const station::World& world, double now) {
  const station::AlertRow* row = station::alert_row(alert.code);
  const bool act = alert.priority == station::Priority::act;
  const bool ends_when_seen = !row || row->ends == station::Ends::seen;
  Need need{.id = "alert " + std::to_string(alert.id),
            .robots = alert.robots,
            .who = alert.robots.empty() ? "station" : command::joined(alert.robots, ""),
            .text = alert.text.empty() ? spaced(alert.code) : alert.text,
            .since = age_text(now - alert.first),
            .urgent = act && !alert.seen,
            .can_see = !alert.seen && (act || ends_when_seen),
            .can_wait = !act && !ends_when_seen,
            .alert = alert.id};
  if (alert.robots.size() >= station::AlertQueue::kManyRobots) {
    need.who = std::to_string(alert.robots.size()) + " robots";
    need.text = spaced(alert.code) + ": " + command::joined(alert.robots, "");
  }
  if (alert.count > 1 && alert.robots.size() == 1)
    need.text += " (" + std::to_string(alert.count) + " times)";
  offer_grant(need, alert, world);
  return need;
}

/// Whether the robot stands because this operator stopped it.
bool stopped_here(const station::Robot& robot, const station::World& world) {
  return robot.stops.size() == 1 && robot.stops.front() == world.station;
}

}  // namespace

std::vector<Need> Attention::needs(const station::World& world, const Trails& trails, double now,
                                   double silent) const {
  std::vector<Need> needs;
  for (const Alert& alert : queue_.shown(now)) needs.push_back(need_of(alert, world, now));
  int number = 0;
  for (const station::Robot& robot : world.robots) {
    const Card card = card_of(robot, ++number, silent, trails.stale_after(robot.name));
    if (!robot.mine || !card.needs_operator || queue_.concerns(robot.name)) continue;
    if (card.contact != Contact::lost && stopped_here(robot, world)) continue;
    needs.push_back({.id = "state " + robot.name,
                     .robots = {robot.name},
                     .who = robot.name,
                     .text = card.headline + ": " + card.detail});
  }
  return needs;
}

}  // namespace adit::gui
