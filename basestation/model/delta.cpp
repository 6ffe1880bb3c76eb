// SPDX-License-Identifier: Apache-2.0
#include "basestation/model/delta.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "basestation/model/json.hpp"
#include "basestation/model/json_fields.hpp"

namespace adit::station {

using nlohmann::json;

namespace {

constexpr double kSameTime = 1e-3;  // s

/// Keys of a robot that change all the time.
constexpr std::array<std::string_view, 8> kMotion{"age",     "pose",         "velocity", "tilt",
                                                  "battery", "localisation", "sigma",    "lock_lease_left"};

double age_of(const json& part) {
  const auto age = part.find("age");
  return age != part.end() && age->is_number() ? age->get<double>() : 0.0;
}

/// JSON has no NaN, which is written as null: so that equal values compare equal.
void normalise(json& value) {
  if (value.is_structured())
    for (json& inner : value) normalise(inner);
  else if (value.is_number_float() && !std::isfinite(value.get<double>()))
    value = nullptr;
}

void raise(Urgency& urgency, Urgency to) { urgency = std::max(urgency, to); }

/// The keys that differ. A key that is gone stands in "gone".
json keys_that_differ(const json& before, const json& now, bool heard_since) {
  json out = json::object();
  for (const auto& [key, value] : now.items()) {
    const auto was = before.find(key);
    // The same age at another time is news.
    if (key == "age" ? heard_since : was == before.end() || *was != value) out[key] = value;
  }
  for (const auto& [key, value] : before.items())
    if (!now.contains(key)) out["gone"].push_back(key);
  return out;
}

Urgency urgency_of(const json& keys) {
  if (keys.empty()) return Urgency::none;
  for (const auto& [key, value] : keys.items())
    if (std::ranges::find(kMotion, key) == kMotion.end()) return Urgency::change;
  return Urgency::motion;
}

using Named = std::map<std::string, json>;

/// Adds what differs of one kind of parts under `key`. `most`: the urgency of what differs in a part.
void add_parts(const Named& before, double at_before, const Named& now, double at, const char* key,
               Urgency most, Delta& delta) {
  for (const auto& [name, part] : now) {
    const auto was = before.find(name);
    if (was == before.end()) {
      delta.json[key][name] = part;
      raise(delta.urgency, Urgency::change);
      continue;
    }
    const double heard_before = at_before - age_of(was->second), heard = at - age_of(part);
    const json keys = keys_that_differ(was->second, part, std::abs(heard - heard_before) > kSameTime);
    if (keys.empty()) continue;
    delta.json[key][name] = keys;
    raise(delta.urgency, std::min(urgency_of(keys), most));
  }
  for (const auto& [name, part] : before) {
    if (now.contains(name)) continue;
    delta.json[key][name] = nullptr;
    raise(delta.urgency, Urgency::change);
  }
}

}  // namespace

EncodedWorld encoded(const World& world) {
  EncodedWorld out{.at = world.at,
                   .head = {{"station", world.station},
                            {"link", world.link},
                            {"commands", json_of(world.commands)},
                            {"findings", json_of(world.findings)}}};
  for (const Robot& robot : world.robots) out.robots[robot.name] = json_of(robot);
  for (const StationSummary& station : world.stations) out.stations[station.name] = json_of(station);
  for (const auto& [agent, rate] : world.traffic) out.traffic[agent] = json_of(rate);
  for (auto* parts : {&out.robots, &out.stations, &out.traffic})
    for (auto& [name, part] : *parts) normalise(part);
  return out;
}

Delta difference(const EncodedWorld& before, const EncodedWorld& now) {
  Delta delta{.json = {{"at", now.at}}};
  if (const json head = keys_that_differ(before.head, now.head, true); !head.empty()) {
    delta.json["head"] = head;
    delta.urgency = Urgency::change;
  }
  add_parts(before.robots, before.at, now.robots, now.at, "robots", Urgency::change, delta);
  add_parts(before.stations, before.at, now.stations, now.at, "stations", Urgency::change, delta);
  add_parts(before.traffic, before.at, now.traffic, now.at, "traffic", Urgency::motion, delta);
  return delta;
}

template <class T>
Result<void> WorldBuilder::merge(const json& delta, const char* key, double at, const char* what,
                                 Parts<T>& parts) {
  const auto changed = delta.find(key);
  if (changed == delta.end()) return {};
  if (!changed->is_object())
    return {Reason::malformed, std::string("a difference's '") + key + "' does not fit"};
  for (const auto& [name, keys] : changed->items()) {
    if (keys.is_null()) {
      parts.erase(name);
      continue;
    }
    if (!keys.is_object())
      return {Reason::malformed, std::string("a difference's '") + key + "' does not fit"};
    const auto known = parts.find(name);
    json complete = known == parts.end() ? json::object() : known->second.json;
    for (const auto& [changed_key, value] : keys.items())
      if (changed_key != "gone") complete[changed_key] = value;
    if (const auto gone = keys.find("gone"); gone != keys.end() && gone->is_array())
      for (const json& word : *gone)
        if (word.is_string()) complete.erase(word.get<std::string>());
    auto value = value_from<T>(complete, what);
    if (!value) return value.error();
    // Without an age it was not heard since.
    const double heard =
        keys.contains("age") || known == parts.end() ? at - age_of(complete) : known->second.heard;
    parts[name] = {std::move(complete), std::move(*value), heard};
  }
  return {};
}

Result<void> WorldBuilder::start(const json& complete) {
  auto world = world_from(complete);
  if (!world) return world.error();
  *this = {};
  at_ = world->at;
  const EncodedWorld parts = encoded(*world);
  head_ = parts.head;
  head_world_ = {.station = world->station,
                 .link = world->link,
                 .commands = world->commands,
                 .findings = world->findings};
  for (const Robot& robot : world->robots)
    robots_[robot.name] = {parts.robots.at(robot.name), robot, at_ - robot.age};
  for (const StationSummary& station : world->stations)
    stations_[station.name] = {parts.stations.at(station.name), station, at_ - station.age};
  for (const auto& [agent, rate] : world->traffic)
    traffic_[agent] = {parts.traffic.at(agent), rate, at_ - rate.age};
  for (const Notice& notice : world->notices) notices_.push_back({{}, notice, at_ - notice.age});
  return {};
}

Result<void> WorldBuilder::apply(const json& delta) {
  if (!delta.is_object() || !delta.contains("at") || !delta["at"].is_number())
    return {Reason::malformed, "a difference has no time"};
  at_ = delta["at"].get<double>();
  if (const auto head = delta.find("head"); head != delta.end()) {
    if (!head->is_object()) return {Reason::malformed, "a difference's 'head' does not fit"};
    head_.update(*head);
    auto world = world_from(head_);
    if (!world) return world.error();
    head_world_ = std::move(*world);
  }
  if (auto merged = merge(delta, "robots", at_, "a robot's", robots_); !merged) return merged;
  if (auto merged = merge(delta, "stations", at_, "a station's", stations_); !merged) return merged;
  return merge(delta, "traffic", at_, "a link report's", traffic_);
}

void WorldBuilder::add(const Notice& notice) {
  if (notices_.size() == kMaxNotices) notices_.erase(notices_.begin());
  notices_.push_back({{}, notice, at_ - notice.age});
}

World WorldBuilder::world() const {
  World world = head_world_;
  world.at = at_;
  for (const auto& [name, part] : robots_) {
    world.robots.push_back(part.value);
    world.robots.back().age = at_ - part.heard;
  }
  for (const bool self : {true, false})
    for (const auto& [name, part] : stations_) {
      if (part.value.self != self) continue;
      world.stations.push_back(part.value);
      world.stations.back().age = self ? part.value.age : at_ - part.heard;
    }
  for (const auto& part : notices_) {
    world.notices.push_back(part.value);
    world.notices.back().age = at_ - part.heard;
  }
  for (const auto& [agent, part] : traffic_) {
    world.traffic[agent] = part.value;
    world.traffic[agent].age = at_ - part.heard;
  }
  return world;
}

}  // namespace adit::station
