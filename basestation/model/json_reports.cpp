// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include "basestation/model/found.hpp"
#include "basestation/model/health.hpp"
#include "basestation/model/json.hpp"
#include "basestation/model/json_fields.hpp"
#include "basestation/model/network.hpp"
#include "basestation/model/outcome.hpp"
#include "core/command/vocabulary.hpp"

namespace adit::station {

using nlohmann::json;

const char* word(PartState state) {
  constexpr std::array kWords{"starting", "up", "waiting", "FAILED", "HUNG"};
  const auto index = static_cast<std::size_t>(state);
  return index < kWords.size() ? kWords[index] : "FAILED";
}

const char* to_string(Verdict verdict) {
  constexpr std::array kWords{"open", "confirmed", "rejected"};
  return kWords[std::min(static_cast<std::size_t>(verdict), kWords.size() - 1)];
}

template <class Io>
void fields(Io& io, Of<Io, ComponentHealth>& component) {
  io.field("component", component.name);
  io.word("state", component.state, PartState::hung, [](PartState state) { return word(state); });
  io.field("healthy", component.healthy);
  io.flag("policy", component.automatic, "manual", "auto");
  if constexpr (!Io::kReads) io.field("can_restart", command::is_component(component.name));
  io.field("silent_for", component.silent_for);
  io.field("restarts", component.restarts);
  io.field("hung", component.hung);
  io.field("text", component.text);
}

template <class Io>
void fields(Io& io, Of<Io, RobotHealth>& health) {
  io.field("robot", health.robot);
  io.field("components", health.components);
}

template <class Io>
void fields(Io& io, Of<Io, HealthReport>& report) {
  io.field("robots", report.robots);
}

template <class Io>
void fields(Io& io, Of<Io, TopicTraffic>& rate) {
  io.field("topic", rate.topic);
  io.field("bytes_out", rate.bytes_out);
  io.field("samples_out", rate.samples_out);
  io.field("bytes_in", rate.bytes_in);
  io.field("samples_in", rate.samples_in);
  io.field("dropped", rate.dropped);
}

template <class Io>
void fields(Io& io, Of<Io, AgentTraffic>& traffic) {
  io.field("agent", traffic.agent);
  io.field("age", traffic.age);
  io.field("discovery_out", traffic.discovery_out);
  io.field("discovery_in", traffic.discovery_in);
  io.field("total_out", traffic.total_out);
  io.field("total_in", traffic.total_in);
  io.field("malformed", traffic.malformed);
  io.field("topics", traffic.topics);
  io.field("classes_out", traffic.classes_out);
  io.field("hears", traffic.hears);
}

template <class Io>
void fields(Io& io, Of<Io, SenderReport>& sender) {
  io.field("link", sender.link);
  io.field("bandwidth", sender.bandwidth);
  io.field("queue", sender.queue);
  io.field("state_rate", sender.state_rate);
  io.field("dropped", sender.dropped);
}

template <class Io>
void fields(Io& io, Of<Io, LinkReport>& link) {
  io.field("agent", link.agent);
  io.field("age", link.age);
  io.field("lost_from", link.lost_from);
  io.field("lost_to", link.lost_to);
  io.field("round_trip", link.round_trip);
  io.field("bytes_from", link.bytes_from);
  io.field("bytes_to", link.bytes_to);
  io.field("signal", link.signal);
  io.field("sender", link.sender);
}

template <class Io>
void fields(Io& io, Of<Io, NetworkReport>& report) {
  io.field("agents", report.agents);
  io.field("links", report.links);
  if (Io::kReads || report.sender) io.field("sender", report.sender);
}

template <class Io>
void fields(Io& io, Of<Io, FoundItem>& item) {
  io.field("number", item.number);
  io.field("robot", item.robot);
  io.field("id", item.id);
  io.field("kind", item.kind);
  io.field("importance", item.importance);
  io.field("position", item.position);
  io.field("text", item.text);
  if (Io::kReads || item.age) io.field("age", item.age);
  io.word("verdict", item.verdict, Verdict::rejected, [](Verdict verdict) { return to_string(verdict); });
  io.field("note", item.note);
}

template <class Io>
void fields(Io& io, Of<Io, FoundAtRobot>& robot) {
  io.field("robot", robot.robot);
  io.field("stored", robot.stored);
  io.field("here", robot.here);
  io.field("overflowed", robot.overflowed);
}

template <class Io>
void fields(Io& io, Of<Io, FoundReport>& report) {
  io.field("findings", report.findings);
  io.field("at_robots", report.at_robots);
}

namespace {

template <class T>
Result<T> report_of(const CommandOutcome& outcome, const char* what) {
  if (outcome.exit_code != kExitDone)
    return {Reason::no_answer, outcome.error.empty() ? "the station did not answer" : outcome.error};
  const json object = json::parse(outcome.json, nullptr, false);
  if (object.is_discarded()) return {Reason::malformed, std::string(what) + " is no JSON"};
  return value_from<T>(object, what);
}

}  // namespace

template <class T>
json json_of(const T& value) {
  return JsonWriter::of(value);
}
template json json_of(const Counts& counts);
template json json_of(const Robot& robot);
template json json_of(const Notice& notice);
template json json_of(const StationSummary& station);
template json json_of(const AgentRate& rate);
template json json_of(const World& world);
template json json_of(const CommandEvent& event);
template json json_of(const HealthReport& report);
template json json_of(const NetworkReport& report);
template json json_of(const FoundReport& report);

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
