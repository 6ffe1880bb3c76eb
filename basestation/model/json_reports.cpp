// SPDX-License-Identifier: Apache-2.0
#include "basestation/model/json_reports.hpp"

#include "basestation/model/exit_code.hpp"
#include "core/command/vocabulary.hpp"

namespace adit::station {

using nlohmann::json;

namespace {

template <class T>
json list_of(const std::vector<T>& values) {
  json out = json::array();
  for (const T& value : values) out.push_back(json_of(value));
  return out;
}

json or_null(const std::optional<double>& value) { return value ? json(*value) : json(nullptr); }

template <class T>
Result<T> report_of(const CommandOutcome& outcome, const char* what) {
  if (outcome.exit_code != kExitDone)
    return {Reason::no_answer, outcome.error.empty() ? "the station did not answer" : outcome.error};
  const json object = json::parse(outcome.json, nullptr, false);
  if (object.is_discarded()) return {Reason::malformed, std::string(what) + " is no JSON"};
  return value_from<T>(object, what);
}

}  // namespace

const char* word(ComponentPhase phase) {
  switch (phase) {
    case ComponentPhase::starting:
      return "starting";
    case ComponentPhase::up:
      return "up";
    case ComponentPhase::waiting:
      return "waiting";
    case ComponentPhase::failed:
      return "FAILED";
    case ComponentPhase::hung:
      return "HUNG";
  }
  return "FAILED";
}

const char* to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::open:
      return "open";
    case Verdict::confirmed:
      return "confirmed";
    case Verdict::rejected:
      break;
  }
  return "rejected";
}

json json_of(const ComponentView& component) {
  return {{"component", component.name},
          {"state", word(component.phase)},
          {"healthy", component.healthy},
          {"policy", component.automatic ? "auto" : "manual"},
          {"can_restart", command::is_component(component.name)},
          {"silent_for", component.silent_for},
          {"restarts", component.restarts},
          {"hung", component.hung},
          {"text", component.text}};
}

void read_fields(JsonReader& in, ComponentView& component) {
  in.read("component", component.name);
  in.read_word("state", component.phase, ComponentPhase::hung,
               [](ComponentPhase phase) { return word(phase); });
  in.read("healthy", component.healthy);
  std::string policy = component.automatic ? "auto" : "manual";
  in.read("policy", policy);
  component.automatic = policy == "auto";
  if (!component.automatic && policy != "manual") in.refuse("policy");
  in.read("silent_for", component.silent_for);
  in.read("restarts", component.restarts);
  in.read("hung", component.hung);
  in.read("text", component.text);
}

json json_of(const RobotHealth& health) {
  return {{"robot", health.robot}, {"components", list_of(health.components)}};
}

void read_fields(JsonReader& in, RobotHealth& health) {
  in.read("robot", health.robot);
  in.read("components", health.components);
}

json json_of(const HealthReport& report) { return {{"robots", list_of(report.robots)}}; }
void read_fields(JsonReader& in, HealthReport& report) { in.read("robots", report.robots); }

json json_of(const TopicRate& rate) {
  return {{"topic", rate.topic},       {"bytes_out", rate.bytes_out},   {"samples_out", rate.samples_out},
          {"bytes_in", rate.bytes_in}, {"samples_in", rate.samples_in}, {"dropped", rate.dropped}};
}

void read_fields(JsonReader& in, TopicRate& rate) {
  in.read("topic", rate.topic);
  in.read("bytes_out", rate.bytes_out);
  in.read("samples_out", rate.samples_out);
  in.read("bytes_in", rate.bytes_in);
  in.read("samples_in", rate.samples_in);
  in.read("dropped", rate.dropped);
}

json json_of(const AgentTraffic& traffic) {
  return {{"agent", traffic.agent},
          {"age", traffic.age},
          {"discovery_out", traffic.discovery_out},
          {"discovery_in", traffic.discovery_in},
          {"total_out", traffic.total_out},
          {"total_in", traffic.total_in},
          {"malformed", traffic.malformed},
          {"topics", list_of(traffic.topics)},
          {"classes_out", traffic.classes_out},
          {"hears", traffic.hears}};
}

void read_fields(JsonReader& in, AgentTraffic& traffic) {
  in.read("agent", traffic.agent);
  in.read("age", traffic.age);
  in.read("discovery_out", traffic.discovery_out);
  in.read("discovery_in", traffic.discovery_in);
  in.read("total_out", traffic.total_out);
  in.read("total_in", traffic.total_in);
  in.read("malformed", traffic.malformed);
  in.read("topics", traffic.topics);
  in.read("classes_out", traffic.classes_out);
  in.read("hears", traffic.hears);
}

json json_of(const SenderReport& sender) {
  return {{"link", sender.link},
          {"bandwidth", sender.bandwidth},
          {"queue", sender.queue},
          {"state_rate", sender.state_rate},
          {"dropped", sender.dropped}};
}

void read_fields(JsonReader& in, SenderReport& sender) {
  in.read("link", sender.link);
  in.read("bandwidth", sender.bandwidth);
  in.read("queue", sender.queue);
  in.read("state_rate", sender.state_rate);
  in.read("dropped", sender.dropped);
}

json json_of(const LinkReport& link) {
  return {{"agent", link.agent},
          {"age", link.age},
          {"lost_from", link.lost_from},
          {"lost_to", or_null(link.lost_to)},
          {"round_trip", or_null(link.round_trip)},
          {"bytes_from", or_null(link.bytes_from)},
          {"bytes_to", or_null(link.bytes_to)},
          {"signal", or_null(link.signal)},
          {"sender", link.sender ? json_of(*link.sender) : json(nullptr)}};
}

void read_fields(JsonReader& in, LinkReport& link) {
  in.read("agent", link.agent);
  in.read("age", link.age);
  in.read("lost_from", link.lost_from);
  in.read("lost_to", link.lost_to);
  in.read("round_trip", link.round_trip);
  in.read("bytes_from", link.bytes_from);
  in.read("bytes_to", link.bytes_to);
  in.read("signal", link.signal);
  in.read("sender", link.sender);
}

json json_of(const NetworkReport& report) {
  json out{{"agents", list_of(report.agents)}, {"links", list_of(report.links)}};
  if (report.sender) out["sender"] = json_of(*report.sender);
  return out;
}

void read_fields(JsonReader& in, NetworkReport& report) {
  in.read("agents", report.agents);
  in.read("links", report.links);
  in.read("sender", report.sender);
}

json json_of(const FoundItem& item) {
  json out{{"number", item.number},
           {"robot", item.robot},
           {"id", item.id},
           {"kind", item.kind},
           {"importance", item.importance},
           {"position", item.position},
           {"text", item.text},
           {"verdict", to_string(item.verdict)},
           {"note", item.note}};
  if (item.age) out["age"] = *item.age;
  return out;
}

void read_fields(JsonReader& in, FoundItem& item) {
  in.read("number", item.number);
  in.read("robot", item.robot);
  in.read("id", item.id);
  in.read("kind", item.kind);
  in.read("importance", item.importance);
  in.read("position", item.position);
  in.read("text", item.text);
  in.read("age", item.age);
  in.read_word("verdict", item.verdict, Verdict::rejected,
               [](Verdict verdict) { return to_string(verdict); });
  in.read("note", item.note);
}

json json_of(const FoundAtRobot& robot) {
  return {{"robot", robot.robot},
          {"stored", robot.stored},
          {"here", robot.here},
          {"overflowed", robot.overflowed}};
}

void read_fields(JsonReader& in, FoundAtRobot& robot) {
  in.read("robot", robot.robot);
  in.read("stored", robot.stored);
  in.read("here", robot.here);
  in.read("overflowed", robot.overflowed);
}

json json_of(const FoundReport& report) {
  return {{"findings", list_of(report.findings)}, {"at_robots", list_of(report.at_robots)}};
}

void read_fields(JsonReader& in, FoundReport& report) {
  in.read("findings", report.findings);
  in.read("at_robots", report.at_robots);
}

Result<HealthReport> health_of(const CommandOutcome& outcome) {
  return report_of<HealthReport>(outcome, "a health report's");
}
Result<NetworkReport> network_of(const CommandOutcome& outcome) {
  return report_of<NetworkReport>(outcome, "a network report's");
}
Result<FoundReport> findings_of(const CommandOutcome& outcome) {
  return report_of<FoundReport>(outcome, "the findings'");
}

std::string findings_text_of(const FoundReport& report) {
  return json_of(report).dump(2, ' ', true, json::error_handler_t::replace) + "\n";
}

}  // namespace adit::station
