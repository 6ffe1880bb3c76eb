// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "basestation/model/json_reader.hpp"
#include "basestation/model/outcome.hpp"
#include "basestation/model/world.hpp"

/// The keys of each value of the model, once for both directions: for JsonReader and JsonWriter.
namespace adit::station {

template <class Io, class T>
using Of = typename Io::template Value<T>;

template <class Io>
void fields(Io& io, Of<Io, Epoch>& epoch) {
  io.field("start", epoch.start);
  io.field("counter", epoch.counter);
}

template <class Io>
void fields(Io& io, Of<Io, ModeOption>& option) {
  io.field("mode", option.mode);
  io.field("available", option.available);
  io.field("reason", option.reason);
}

template <class Io>
void fields(Io& io, Of<Io, contract::Exploration>& e) {
  io.word("state", e.phase, ExplorationPhase::ended, [](ExplorationPhase p) { return to_string(p); });
  io.field("reason", e.reason);
  io.field("volume", e.volume);
  io.field("share", e.share);
  io.field("open", e.open);
  io.field("unreachable", e.unreachable);
}

template <class Io>
void fields(Io& io, Of<Io, Area>& area) {
  io.field("name", area.name);
  io.word("kind", area.kind, AreaKind::prefer, [](AreaKind kind) { return name(kind); });
  io.field("corners", area.corners);
  if (Io::kReads || area.kind == AreaKind::prefer) io.field("weight", area.weight);
  if (Io::kReads || std::isfinite(area.z_min)) io.field("z_min", area.z_min);
  if (Io::kReads || std::isfinite(area.z_max)) io.field("z_max", area.z_max);
}

template <class Io>
void fields(Io& io, Of<Io, contract::Route>& route) {
  io.field("goal_id", route.goal_id);
  io.field("points", route.points);
  io.field("unknown", route.unknown);
  io.field("corners", route.corners);
  if constexpr (Io::kReads)
    if (route.points.size() > contract::Route::kMaxCorners) io.refuse("points");
}

template <class Io>
void fields(Io& io, Of<Io, Size>& size) {
  io.known("length", size.length);
  io.known("width", size.width);
  io.known("height", size.height);
}

template <class Io>
void fields(Io& io, Of<Io, CameraStatus>& camera) {
  io.field("name", camera.name);
  io.field("on", camera.on);
  io.field("kept_on", camera.kept_on);
  io.field("width", camera.width);
  io.field("height", camera.height);
  io.field("age", camera.age);
  io.field("rate", camera.rate);
  io.field("bytes", camera.bytes);
}

template <class Io>
void place_fields(Io& io, Of<Io, Robot>& robot) {
  if constexpr (Io::kReads) robot.located = io.has("pose");
  if (!Io::kReads && !robot.located) return;
  io.list("pose", robot.x, robot.y, robot.z, robot.yaw);
  io.list("velocity", robot.vx, robot.vy, robot.wz);
  io.list("tilt", robot.roll, robot.pitch);
  io.field("map_revision", robot.map_revision);
  if (Io::kReads || robot.battery >= 0.0F) io.field("battery", robot.battery);
  io.word("localisation", robot.localisation, Localisation::lost, [](Localisation l) { return name(l); });
  if (Io::kReads || robot.localisation != Localisation::off) io.field("sigma", robot.sigma);
}

template <class Io>
void fields(Io& io, Of<Io, Robot>& robot) {
  if constexpr (Io::kReads)
    if (!io.has("robot")) io.refuse("robot");
  io.field("robot", robot.name);
  io.field("age", robot.age);
  io.field("lost", robot.lost);
  io.field("described", robot.described);
  io.field("kind", robot.platform);
  io.field("software", robot.software);
  io.field("protocol", robot.protocol);
  io.field("max_speed", robot.max_speed);
  io.field("max_turn", robot.max_turn);
  io.field("sensors", robot.sensors);
  io.field("services", robot.services);
  io.field("holder", robot.holder);
  io.field("mine", robot.mine);
  io.field("locked", robot.locked);
  io.field("lock_lease_left", robot.lease_left);
  io.field("epoch", robot.epoch);
  io.field("stops", robot.stops);
  io.field("stopped_by_holder", robot.stopped_by_holder);
  io.field("stopped", robot.stopped);
  io.field("mode", robot.mode);
  io.field("moving_allowed", robot.moving_allowed);
  io.field("reason", robot.reason);
  io.word("recovery", robot.recovery, RecoveryState::give_up, [](RecoveryState s) { return to_string(s); });
  io.word("goal_state", robot.goal_state, GoalState::reached, [](GoalState s) { return to_string(s); });
  io.field("goal_id", robot.goal_id);
  io.field("modes", robot.options);
  io.field("convoy", robot.convoy);
  io.field("yields", robot.yields);
  io.field("yields_to", robot.yields_to);
  io.field("troubles", robot.troubles);
  if (Io::kReads || robot.described) {
    io.field("size", robot.size);
    io.known("max_acceleration", robot.max_acceleration);
    io.field("holonomic", robot.holonomic);
    io.field("max_step", robot.max_step);
    io.known("max_slope", robot.max_slope);
    io.field("climbs_stairs", robot.climbs_stairs);
  }
  place_fields(io, robot);
  if (Io::kReads || robot.goal_state != GoalState::none) io.field("goal", robot.goal);
  if (Io::kReads || !robot.route.points.empty()) io.field("route", robot.route);
  if (Io::kReads || !robot.cameras.empty()) io.field("cameras", robot.cameras);
  io.field("areas", robot.areas);
  if (Io::kReads || robot.exploration.phase != ExplorationPhase::none)
    io.field("exploration", robot.exploration);
}

template <class Io>
void fields(Io& io, Of<Io, Counts>& counts) {
  io.field("sent", counts.sent);
  io.field("repeats", counts.repeats);
  io.field("accepted", counts.accepted);
  io.field("refused", counts.refused);
  io.field("unanswered", counts.unanswered);
}

template <class Io>
void fields(Io& io, Of<Io, Notice>& notice) {
  io.field("id", notice.id);
  io.field("age", notice.age);
  io.field("robot", notice.robot);
  io.field("operator", notice.operator_name);
  io.word("level", notice.severity, Severity::error, [](Severity s) { return to_string(s); });
  io.field("code", notice.code);
  io.field("reason", notice.reason);
  io.field("text", notice.text);
  io.field("mine", notice.mine);
}

template <class Io>
void fields(Io& io, Of<Io, StationSummary>& station) {
  io.field("station", station.name);
  io.field("self", station.self);
  io.field("age", station.age);
  io.field("lost", station.lost);
  if (Io::kReads || station.place) io.field("place", station.place);
}

template <class Io>
void fields(Io& io, Of<Io, AgentRate>& rate) {
  io.field("out", rate.out);
  io.field("in", rate.in);
  io.field("age", rate.age);
}

template <class Io>
void fields(Io& io, Of<Io, FindingCounts>& counts) {
  io.field("listed", counts.listed);
  io.field("open", counts.open);
  io.field("changes", counts.changes);
}

template <class Io>
void fields(Io& io, Of<Io, World>& world) {
  io.field("at", world.at);
  io.field("station", world.station);
  io.field("link", world.link);
  io.field("commands", world.commands);
  io.field("findings", world.findings);
  io.field("robots", world.robots);
  io.field("stations", world.stations);
  io.field("notices", world.notices);
  io.field("traffic", world.traffic);
}

template <class Io>
void fields(Io& io, Of<Io, CommandEvent>& event) {
  std::string phase = event.ended ? "ended" : "begun";
  io.field("id", event.id);
  io.field("phase", phase);
  if constexpr (Io::kReads)
    event.ended = phase == "ended";
  else
    io.field("event", "command");
  io.field("line", event.line);
  io.field("query", event.query);
  io.field("mine", event.mine);
  io.object("by", [&](Io& by) {
    by.field("front_end", event.front_end);
    by.field("pid", event.pid);
  });
  if (!Io::kReads && !event.ended) return;
  io.field("exit", event.exit_code);
  io.field("text", event.text);
  io.field("error", event.error);
}

template <class Io>
void fields(Io& io, Of<Io, RobotAnswer>& answer) {
  io.field("robot", answer.robot);
  io.field("accepted", answer.accepted);
  io.field("answered", answer.answered);
  io.field("reason", answer.reason);
  io.field("text", answer.text);
  io.field("holder", answer.holder);
}

}  // namespace adit::station
