// SPDX-License-Identifier: Apache-2.0
#include "basestation/report/json.hpp"

#include "basestation/fleet/summary.hpp"
#include "basestation/model/json.hpp"

namespace adit::station {

using nlohmann::json;

namespace {

json or_null(const std::optional<double>& value) { return value ? json(*value) : json(nullptr); }

}  // namespace

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
  if (answer.route)
    out["route"] = {{"length", answer.route->length},
                    {"unknown_length", answer.route->unknown_length},
                    {"complete", answer.route->corners <= answer.route->points.size()},
                    {"points", answer.route->points}};
  return out;
}

namespace {

const char* to_string(command::Type type) {
  switch (type) {
    case command::Type::robots:
      return "robots";
    case command::Type::name:
      return "name";
    case command::Type::file:
      return "file";
    case command::Type::choice:
      return "choice";
    case command::Type::number:
      return "number";
    case command::Type::command:
      return "command";
    case command::Type::keyword:
      return "keyword";
    case command::Type::none:
      break;
  }
  return "none";
}

const char* to_string(command::Danger danger) {
  switch (danger) {
    case command::Danger::none:
      return "none";
    case command::Danger::some:
      return "some";
    case command::Danger::high:
      break;
  }
  return "high";
}

json argument_json(const command::Argument& argument) {
  json out{{"name", argument.name},
           {"type", to_string(argument.type)},
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
  return {{"arguments", arguments},           {"options", options},
          {"danger", to_string(info.danger)}, {"robots_min", robots.min_count},
          {"robots_max", robots.max_count},   {"all_robots", robots.all},
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

json sender_json(const SenderView& sender) {
  json dropped = json::object();
  for (std::size_t p = 0; p < wire::kPriorities; ++p) dropped[priority_name(p)] = sender.dropped[p];
  return {{"link", sender.link},
          {"bandwidth", sender.bandwidth},
          {"queue", sender.queue},
          {"state_rate", sender.state_rate},
          {"dropped", dropped}};
}

}  // namespace

json net_json(const Fleet& fleet, Time now) {
  json agents = json::array();
  for (const auto& [agent, traffic] : fleet.traffic()) {
    json topics = json::array();
    for (const TopicRate& row : traffic.topics)
      topics.push_back({{"topic", row.topic},
                        {"bytes_out", row.bytes_out},
                        {"samples_out", row.samples_out},
                        {"bytes_in", row.bytes_in},
                        {"samples_in", row.samples_in},
                        {"dropped", row.dropped}});
    agents.push_back({{"agent", agent},
                      {"age", seconds(now - traffic.last_heard)},
                      {"discovery_out", traffic.discovery_out},
                      {"discovery_in", traffic.discovery_in},
                      {"total_out", traffic.total_out},
                      {"total_in", traffic.total_in},
                      {"malformed", traffic.malformed},
                      {"topics", topics}});
  }
  json rows = json::array();
  for (const LinkView& link : links(fleet, now)) {
    json row{{"agent", link.peer.name},
             {"age", seconds(link.peer.held)},
             {"lost_from", link.peer.lost},
             {"lost_to", or_null(link.lost_to)},
             {"round_trip", or_null(link.peer.round_trip)},
             {"bytes_from", link.rate ? json(link.rate->in) : json(nullptr)},
             {"bytes_to", link.rate ? json(link.rate->out) : json(nullptr)},
             {"signal", link.rate ? or_null(link.rate->signal) : json(nullptr)}};
    row["sender"] = link.sender ? sender_json(*link.sender) : json(nullptr);
    rows.push_back(std::move(row));
  }
  json out{{"agents", agents}, {"links", rows}};
  const auto own = fleet.traffic().find(fleet.own_name());
  if (own != fleet.traffic().end()) out["sender"] = sender_json(own->second.sender);
  return out;
}

json health_json(const RobotView& robot) {
  json parts = json::array();
  for (const ComponentView& part : robot.components)
    parts.push_back({{"component", part.name},
                     {"state", word(part.phase)},
                     {"healthy", part.healthy},
                     {"policy", part.automatic ? "auto" : "manual"},
                     {"silent_for", part.silent_for},
                     {"restarts", part.restarts},
                     {"hung", part.hung},
                     {"text", part.text}});
  return {{"robot", robot.name}, {"components", parts}};
}

json list_json(const Fleet& fleet, Time now) {
  json robots = json::array(), stations = json::array();
  for (const Robot& robot : robots_of(fleet, now)) robots.push_back(json_of(robot));
  for (const StationSummary& station : stations_of(fleet, now)) stations.push_back(json_of(station));
  return {{"robots", robots}, {"stations", stations}};
}

}  // namespace adit::station
