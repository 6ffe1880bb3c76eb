// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/bridge/details.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "basestation/gui/bridge/card.hpp"
#include "basestation/model/route.hpp"
#include "basestation/model/text.hpp"
#include "core/command/words.hpp"

namespace adit::gui {
namespace {

using command::joined;
using station::exploration_text;
using station::fixed;
using station::GoalState;
using station::kUnknownPlace;
using station::Robot;
using station::World;

std::string degrees(double angle) { return fixed(angle * 180.0 / std::numbers::pi, 0) + " degrees"; }

constexpr float kTilted = 0.05F;  // rad: less is not worth a row.

std::string holder(const Robot& robot) {
  std::string text = robot.mine ? "you" : robot.holder.empty() ? "none" : robot.holder;
  if (robot.locked) text += ", locked";
  if (robot.locked && robot.lease_left >= 0.0F) text += ", lapses in " + fixed(robot.lease_left, 0) + " s";
  return text;
}

std::string mode(const Robot& robot) {
  if (robot.mode.empty()) return "not heard yet";
  const std::string why = station::standstill_text(robot);
  return robot.mode + (why.empty() ? "" : ": " + why);
}

std::string place(const Robot& robot) {
  return "x " + fixed(robot.x, 1) + "  y " + fixed(robot.y, 1) + "  z " + fixed(robot.z, 1) + " m, heading " +
         degrees(robot.yaw);
}

std::string localisation(const Robot& robot) {
  if (robot.localisation == Localisation::off) return "taken as it is";
  return std::string(name(robot.localisation)) +
         (robot.sigma < kUnknownPlace ? ", known to " + fixed(robot.sigma, 2) + " m" : ", unknown");
}

std::string goal(const Robot& robot) {
  std::string text = std::string(to_string(robot.goal_state)) + ": " + fixed(robot.goal[0], 1) + " " +
                     fixed(robot.goal[1], 1);
  if (robot.located && robot.goal_state != GoalState::reached)
    text += ", " + fixed(std::hypot(robot.goal[0] - robot.x, robot.goal[1] - robot.y), 1) + " m away";
  return text;
}

std::string yields(const Robot& robot) {
  if (!robot.yields_to.empty()) return "makes way for " + robot.yields_to;
  return robot.yields ? "allowed" : "not allowed";
}

/// The rows of one robot. What it does not have is left out.
std::vector<Detail> rows_of(const Robot& robot, const World& world, double silent) {
  std::vector<Detail> rows;
  const auto add = [&](std::string label, std::string value, DetailAction action = {}) {
    rows.push_back({.label = std::move(label), .value = std::move(value), .action = std::move(action)});
  };
  add("heard", age_text(robot.age + silent) + " ago" + (robot.lost ? ", LOST" : ""));
  add("mode", mode(robot));
  add("holder", holder(robot));
  if (!robot.stops.empty()) add("stopped by", joined(robot.stops, ""));
  if (robot.goal_state != GoalState::none) add("goal", goal(robot));
  if (const std::string way = station::route_text(robot); !way.empty()) add("route", way);
  if (robot.exploration.phase != station::ExplorationPhase::none)
    add("explored", exploration_text(robot.exploration));
  if (!robot.convoy.empty()) add("convoy", joined(robot.convoy, ""));
  if (!robot.troubles.empty()) add("components", joined(robot.troubles, ""));
  add("battery", robot.battery < 0.0F ? "-" : fixed(100.0 * robot.battery, 0) + " %");
  if (robot.located) {
    add("place", place(robot));
    add("localisation", localisation(robot));
    if (std::hypot(robot.roll, robot.pitch) > kTilted)
      add("tilt", "roll " + degrees(robot.roll) + ", pitch " + degrees(robot.pitch));
    add("speed", fixed(std::hypot(robot.vx, robot.vy), 2) + " m/s, turn " + fixed(robot.wz, 2) + " rad/s");
  }
  if (robot.mine)
    add("make way", yields(robot),
        robot.yields ? DetailAction{"Forbid", "yield " + robot.name + " off"}
                     : DetailAction{"Allow", "yield " + robot.name + " on"});
  else if (robot.yields || !robot.yields_to.empty())
    add("make way", yields(robot));
  for (const Area& area : robot.areas)
    add("area " + area.name,
        std::string(name(area.kind)) + ", " + std::to_string(area.corners.size()) + " corners",
        robot.mine && command::valid_name(area.name)
            ? DetailAction{"Remove", "area " + robot.name + " remove " + area.name, true}
            : DetailAction{});
  for (const station::StationSummary& other : world.stations)
    if (robot.mine && !other.self)
      add("hand to " + other.name, other.lost ? "lost" : "heard " + age_text(other.age + silent) + " ago",
          other.lost ? DetailAction{}
                     : DetailAction{"Grant", "grant " + robot.name + " " + other.name, true});
  if (robot.described) {
    add("kind", robot.platform);
    add("size", size_text(robot.size));
    add("limits", limits_text(robot));
    add("sensors", joined(robot.sensors, "-"));
    add("services", joined(robot.services, "-"));
    add("software", robot.software + ", protocol " + std::to_string(robot.protocol));
  }
  if (const auto rate = world.traffic.find(robot.name); rate != world.traffic.end())
    add("radio",
        "sends " + fixed(rate->second.out, 0) + " B/s, receives " + fixed(rate->second.in, 0) + " B/s");
  return rows;
}

/// The rows of several robots as one list: what is the same is there once.
std::vector<Detail> merged(const std::vector<const Robot*>& robots, const World& world, double silent) {
  struct Row {
    std::string label{};
    std::vector<std::string> names{};
    std::vector<Detail> details{};
  };
  std::vector<Row> rows;
  for (const Robot* robot : robots)
    for (Detail& detail : rows_of(*robot, world, silent)) {
      auto row =
          std::find_if(rows.begin(), rows.end(), [&](const Row& r) { return r.label == detail.label; });
      if (row == rows.end()) row = rows.insert(row, {.label = detail.label});
      row->names.push_back(robot->name);
      row->details.push_back(std::move(detail));
    }
  std::vector<Detail> out;
  for (const Row& row : rows) {
    Detail all = row.details.front();
    const bool same = row.details.size() == robots.size() &&
                      std::all_of(row.details.begin(), row.details.end(),
                                  [&](const Detail& detail) { return detail.value == all.value; });
    if (robots.size() > 1) all.action = {};  // An order to several robots belongs to the action bar.
    if (!same && robots.size() > 1) {
      all.differs = true;
      all.value.clear();
      for (std::size_t i = 0; i < row.names.size(); ++i)
        all.value += (i == 0 ? "" : "  ·  ") + row.names[i] + ": " + row.details[i].value;
    }
    out.push_back(std::move(all));
  }
  return out;
}

/// The rows of all robots together.
std::vector<Detail> fleet_rows(const World& world) {
  std::size_t own = 0, lost = 0, stopped = 0, moving = 0;
  const Robot* weakest = nullptr;
  for (const Robot& robot : world.robots) {
    own += robot.mine;
    lost += robot.lost;
    stopped += robot.stopped || !robot.stops.empty();
    moving += !robot.lost && std::hypot(robot.vx, robot.vy) > 0.05F;
    if (robot.battery >= 0.0F && (!weakest || robot.battery < weakest->battery)) weakest = &robot;
  }
  std::vector<Detail> rows{{.label = "robots", .value = std::to_string(world.robots.size())},
                           {.label = "yours", .value = std::to_string(own)},
                           {.label = "moving", .value = std::to_string(moving)},
                           {.label = "stopped", .value = std::to_string(stopped)},
                           {.label = "lost", .value = std::to_string(lost)}};
  if (weakest)
    rows.push_back({.label = "least battery",
                    .value = weakest->name + ", " + fixed(100.0 * weakest->battery, 0) + " %"});
  rows.push_back({.label = "commands",
                  .value = std::to_string(world.commands.accepted) + " accepted, " +
                           std::to_string(world.commands.refused) + " refused"});
  rows.push_back({.label = "first steps",
                  .value = "Tap a robot, Take it, then press and hold a place of the map to send it there."});
  return rows;
}

}  // namespace

std::vector<Detail> details_of(const World& world, const std::vector<std::string>& selection, double silent) {
  std::vector<const Robot*> robots;
  for (const std::string& name : selection)
    if (const Robot* robot = world.robot(name)) robots.push_back(robot);
  return robots.empty() ? fleet_rows(world) : merged(robots, world, silent);
}

}  // namespace adit::gui
