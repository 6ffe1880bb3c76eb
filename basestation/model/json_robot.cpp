// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "basestation/model/json.hpp"
#include "basestation/model/json_fields.hpp"

namespace adit::station {

using nlohmann::json;

namespace {

/// Returns null for 0, which means unknown.
json known(float amount) { return amount > 0.0F ? json(amount) : json(nullptr); }

/// Reads an amount of which null means unknown, 0.
void read_known(JsonReader& in, const char* key, float& amount) {
  in.read(key, amount);
  if (std::isnan(amount)) amount = 0.0F;
}

json abilities_json(const Robot& robot) {
  return {{"size",
           {{"length", known(robot.size.length)},
            {"width", known(robot.size.width)},
            {"height", known(robot.size.height)}}},
          {"max_acceleration", known(robot.max_acceleration)},
          {"holonomic", robot.holonomic},
          {"max_step", robot.max_step},
          {"max_slope", known(robot.max_slope)},
          {"climbs_stairs", robot.climbs_stairs}};
}

json area_json(const AreaView& area) {
  json out{{"name", area.name}, {"kind", area.kind}, {"corners", area.corners}};
  if (area.kind == "prefer") out["weight"] = area.weight;
  if (std::isfinite(area.z_min)) out["z_min"] = area.z_min;
  if (std::isfinite(area.z_max)) out["z_max"] = area.z_max;
  return out;
}

json exploration_json(const ExplorationView& e) {
  return {{"state", to_string(e.phase)},
          {"reason", name(e.reason)},
          {"volume", e.volume},
          {"share", e.share},
          {"open", e.open},
          {"unreachable", e.unreachable}};
}

json route_json(const RouteView& route) {
  return {{"goal_id", route.goal_id},
          {"points", route.points},
          {"unknown", route.unknown},
          {"corners", route.corners}};
}

void read_place(JsonReader& in, Robot& robot) {
  robot.located = in.has("pose");
  std::array<float, 4> pose{};
  std::array<float, 3> velocity{};
  in.read("pose", pose);
  in.read("velocity", velocity);
  robot.x = pose[0], robot.y = pose[1], robot.z = pose[2], robot.yaw = pose[3];
  robot.vx = velocity[0], robot.vy = velocity[1], robot.wz = velocity[2];
  std::array<float, 2> tilt{};
  in.read("tilt", tilt);
  robot.roll = tilt[0], robot.pitch = tilt[1];
  in.read("map_revision", robot.map_revision);
  in.read("battery", robot.battery);
  in.read_word("localisation", robot.localisation, Localisation::lost,
               [](Localisation l) { return adit::name(l); });
  in.read("sigma", robot.sigma);
}

}  // namespace

json json_of(const Robot& robot) {
  json modes = json::array();
  for (const ModeChoice& choice : robot.choices)
    modes.push_back(
        {{"mode", choice.mode}, {"available", choice.available}, {"reason", name(choice.reason)}});
  json out{{"robot", robot.name},
           {"age", robot.age},
           {"lost", robot.lost},
           {"described", robot.described},
           {"kind", robot.platform},
           {"software", robot.software},
           {"protocol", robot.protocol},
           {"max_speed", robot.max_speed},
           {"max_turn", robot.max_turn},
           {"sensors", robot.sensors},
           {"services", robot.services},
           {"holder", robot.holder},
           {"mine", robot.mine},
           {"locked", robot.locked},
           {"lock_lease_left", robot.lease_left},
           {"epoch", {{"start", robot.epoch.start}, {"counter", robot.epoch.counter}}},
           {"stops", robot.stops},
           {"stopped_by_holder", robot.stopped_by_holder},
           {"stopped", robot.stopped},
           {"mode", robot.mode},
           {"moving_allowed", robot.moving_allowed},
           {"reason", name(robot.reason)},
           {"goal_state", to_string(robot.goal_phase)},
           {"goal_id", robot.goal_id},
           {"modes", modes},
           {"convoy", robot.convoy},
           {"yields", robot.yields},
           {"yields_to", robot.yields_to},
           {"troubles", robot.troubles}};
  if (robot.described) out.update(abilities_json(robot));
  if (robot.located) {
    out["pose"] = {robot.x, robot.y, robot.z, robot.yaw};
    out["velocity"] = {robot.vx, robot.vy, robot.wz};
    out["tilt"] = {robot.roll, robot.pitch};
    out["map_revision"] = robot.map_revision;
    if (robot.battery >= 0.0F) out["battery"] = robot.battery;
    out["localisation"] = name(robot.localisation);
    if (robot.localisation != Localisation::off) out["sigma"] = robot.sigma;
  }
  if (robot.goal_phase != GoalPhase::none) out["goal"] = robot.goal;
  if (!robot.route.points.empty()) out["route"] = route_json(robot.route);
  out["areas"] = json::array();
  for (const AreaView& area : robot.areas) out["areas"].push_back(area_json(area));
  if (robot.exploration.phase != ExplorationPhase::none)
    out["exploration"] = exploration_json(robot.exploration);
  return out;
}

void read_fields(JsonReader& in, Epoch& epoch) {
  in.read("start", epoch.start);
  in.read("counter", epoch.counter);
}

void read_fields(JsonReader& in, ModeChoice& choice) {
  in.read("mode", choice.mode);
  in.read("available", choice.available);
  in.read("reason", choice.reason);
}

void read_fields(JsonReader& in, ExplorationView& e) {
  in.read_word("state", e.phase, ExplorationPhase::ended, [](ExplorationPhase p) { return to_string(p); });
  in.read("reason", e.reason);
  in.read("volume", e.volume);
  in.read("share", e.share);
  in.read("open", e.open);
  in.read("unreachable", e.unreachable);
}

void read_fields(JsonReader& in, AreaView& area) {
  in.read("name", area.name);
  in.read("kind", area.kind);
  in.read("corners", area.corners);
  in.read("weight", area.weight);
  in.read("z_min", area.z_min);
  in.read("z_max", area.z_max);
}

void read_fields(JsonReader& in, RouteView& route) {
  in.read("goal_id", route.goal_id);
  in.read("points", route.points);
  in.read("unknown", route.unknown);
  in.read("corners", route.corners);
  if (route.points.size() > RouteView::kMaxCorners) in.refuse("points");
}

void read_fields(JsonReader& in, Size& size) {
  read_known(in, "length", size.length);
  read_known(in, "width", size.width);
  read_known(in, "height", size.height);
}

void read_fields(JsonReader& in, Robot& robot) {
  if (!in.has("robot")) in.refuse("robot");
  in.read("robot", robot.name);
  in.read("age", robot.age);
  in.read("lost", robot.lost);
  in.read("described", robot.described);
  in.read("kind", robot.platform);
  in.read("software", robot.software);
  in.read("protocol", robot.protocol);
  in.read("max_speed", robot.max_speed);
  in.read("max_turn", robot.max_turn);
  in.read("sensors", robot.sensors);
  in.read("services", robot.services);
  in.read("holder", robot.holder);
  in.read("mine", robot.mine);
  in.read("locked", robot.locked);
  in.read("lock_lease_left", robot.lease_left);
  in.read("epoch", robot.epoch);
  in.read("stops", robot.stops);
  in.read("stopped_by_holder", robot.stopped_by_holder);
  in.read("stopped", robot.stopped);
  in.read("mode", robot.mode);
  in.read("moving_allowed", robot.moving_allowed);
  in.read("reason", robot.reason);
  in.read_word("goal_state", robot.goal_phase, GoalPhase::reached, [](GoalPhase p) { return to_string(p); });
  in.read("goal_id", robot.goal_id);
  in.read("modes", robot.choices);
  in.read("convoy", robot.convoy);
  in.read("yields", robot.yields);
  in.read("yields_to", robot.yields_to);
  in.read("troubles", robot.troubles);
  in.read("size", robot.size);
  read_known(in, "max_acceleration", robot.max_acceleration);
  in.read("holonomic", robot.holonomic);
  in.read("max_step", robot.max_step);
  read_known(in, "max_slope", robot.max_slope);
  in.read("climbs_stairs", robot.climbs_stairs);
  read_place(in, robot);
  in.read("goal", robot.goal);
  in.read("route", robot.route);
  in.read("areas", robot.areas);
  in.read("exploration", robot.exploration);
}

Result<Robot> robot_from(const json& object) { return value_from<Robot>(object, "a robot's"); }

}  // namespace adit::station
