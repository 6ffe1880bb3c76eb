// SPDX-License-Identifier: Apache-2.0
#include "basestation/report/json.hpp"

#include "basestation/fleet/summary.hpp"
#include "basestation/model/json.hpp"
#include "core/wire/qos.hpp"
#include "core/wire/topics.hpp"

namespace adit::station {

using nlohmann::json;

json notices_json(const Fleet& fleet, const std::string& robot, Time now) {
  json out = json::array();
  for (const StoredNotice& notice : fleet.notices())
    if (robot.empty() || notice.robot == robot) out.push_back(json_of(described(notice, now)));
  return out;
}

json answer_json(const Answer& answer) {
  json out{{"robot", answer.robot},
           {"accepted", answer.accepted},
           {"answered", answer.answered},
           {"reason", name(answer.reason)},
           {"text", answer.text},
           {"holder", answer.holder},
           {"latency", seconds(answer.latency)}};
  if (!answer.route) return out;
  json points = json::array();
  for (const Eigen::Vector3d& corner : answer.route->points)
    points.push_back({corner.x(), corner.y(), corner.z()});
  out["route"] = {{"length", answer.route->length},
                  {"unknown_length", answer.route->unknown_length},
                  {"complete", answer.route->corners <= answer.route->points.size()},
                  {"points", std::move(points)}};
  return out;
}

namespace {

/// In the order of command::Type and command::Danger.
constexpr std::array kTypes{"none",   "robots", "name",    "file",   "choice",
                            "number", "text",   "command", "keyword"};
constexpr std::array kDangers{"none", "some", "high"};

json argument_json(const command::Argument& argument) {
  json out{{"name", argument.name},
           {"type", kTypes.at(static_cast<std::size_t>(argument.type))},
           {"least", argument.min_count},
           {"most", argument.max_count}};
  if (!argument.choices.empty()) out["choices"] = command::choices(argument);
  if (argument.type == command::Type::number)
    out.update({{"minimum", argument.minimum},
                {"maximum", argument.maximum},
                {"unit", argument.unit},
                {"group", argument.group}});
  return out;
}

/// The properties of an action that a front end needs: robots, arguments, options, danger.
json info_json(const Action& action) {
  const command::CommandInfo& info = *action.info;
  json arguments = json::array(), options = json::array();
  for (const command::Argument& argument : info.arguments)
    if (argument && argument.type != command::Type::robots &&
        (action.mode.empty() || argument.name != info.conditions.mode))
      arguments.push_back(argument_json(argument));
  for (const command::Option& option : info.options) {
    if (!option) continue;
    json values = json::array();
    for (const command::Argument& value : option.values)
      if (value) values.push_back(argument_json(value));
    options.push_back({{"name", option.name}, {"values", values}});
  }
  const command::Argument& robots = info.arguments[0];
  return {{"arguments", arguments},
          {"options", options},
          {"danger", kDangers.at(static_cast<std::size_t>(info.danger))},
          {"robots_min", robots.min_count},
          {"robots_max", robots.max_count},
          {"all_robots", robots.all != command::AllRobots::refused &&
                             (robots.all_only.empty() || robots.all_only == action.mode)},
          {"all_only", action.mode.empty() ? robots.all_only : ""},
          {"usage", command::usage(info)}};
}

}  // namespace

json actions_json(const std::vector<Action>& actions) {
  json rows = json::array();
  for (const Action& action : actions) {
    json row{{"id", id_of(action)},   {"label", label_of(action)},     {"command", action.command},
             {"valid", action.valid}, {"reason", name(action.reason)}, {"text", action.text},
             {"robot", action.robot}};
    row.update(info_json(action));
    rows.push_back(std::move(row));
  }
  return rows;
}

namespace {

/// The class of a topic as the budget counts it: "state", "bulk".
std::string class_of(const std::string& topic) {
  namespace topics = wire::topics;
  static const std::map<std::string, wire::QosClass> classes = [] {
    std::map<std::string, wire::QosClass> out;
    const auto add = [&out](const auto&... all) { ((out[all.name] = all.qos), ...); };
    add(topics::kCapabilities, topics::kPresence, topics::kCommand, topics::kJoystick,
        topics::kAcknowledgement, topics::kAuthority, topics::kRobotState, topics::kBehaviour, topics::kRoute,
        topics::kNotification, topics::kHealth, topics::kLinkReport, topics::kBulk, topics::kBulkAck,
        topics::kTeam);
    return out;
  }();
  const auto known = classes.find(topic);
  if (known == classes.end()) return "other";
  return priority_name(static_cast<std::size_t>(wire::qos_of(known->second).priority));
}

std::map<std::string, double> classes_out(const TrafficView& traffic) {
  std::map<std::string, double> out;
  if (traffic.discovery_out > 0.0F) out["discovery"] = traffic.discovery_out;
  for (const TopicTraffic& rate : traffic.topics)
    if (rate.bytes_out > 0.0F) out[class_of(rate.topic)] += rate.bytes_out;
  return out;
}

}  // namespace

NetworkReport network_report(const Fleet& fleet, Time now) {
  NetworkReport report;
  for (const auto& [agent, traffic] : fleet.traffic()) {
    report.agents.push_back({.agent = agent,
                             .age = seconds(now - traffic.last_heard),
                             .discovery_out = traffic.discovery_out,
                             .discovery_in = traffic.discovery_in,
                             .total_out = traffic.total_out,
                             .total_in = traffic.total_in,
                             .malformed = traffic.malformed,
                             .topics = traffic.topics,
                             .classes_out = classes_out(traffic)});
    for (const contract::PeerLink& peer : traffic.peers) report.agents.back().hears[peer.peer] = peer.lost;
  }
  report.links = links(fleet, now);
  const auto own = fleet.traffic().find(fleet.own_name());
  if (own != fleet.traffic().end()) report.sender = described(own->second);
  return report;
}

HealthReport health_report(const std::vector<const RobotView*>& robots) {
  HealthReport report;
  for (const RobotView* robot : robots) report.robots.push_back({robot->name, robot->components});
  return report;
}

json list_json(const Fleet& fleet, Time now) {
  const json world = json_of(world_of(fleet, now));
  return {{"robots", world["robots"]}, {"stations", world["stations"]}};
}

}  // namespace adit::station
