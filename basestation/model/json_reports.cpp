// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "basestation/model/found.hpp"
#include "basestation/model/health.hpp"
#include "basestation/model/json.hpp"
#include "basestation/model/json_fields.hpp"
#include "basestation/model/network.hpp"
#include "basestation/model/outcome.hpp"
#include "basestation/model/stairs.hpp"
#include "core/command/vocabulary.hpp"

namespace adit::station {

using nlohmann::json;

const char* word(PartState state) {
  constexpr std::array kWords{"starting", "up", "waiting", "FAILED", "HUNG"};
  const auto index = static_cast<std::size_t>(state);
  return index < kWords.size() ? kWords[index] : "FAILED";
}

const char* to_string(PhotoHere here) {
  switch (here) {
    case PhotoHere::none:
      return "none";
    case PhotoHere::thumbnail:
      return "thumbnail";
    case PhotoHere::whole:
      break;
  }
  return "whole";
}

std::string photo_text(const std::optional<FoundPhoto>& photo) {
  if (!photo) return "-";
  const std::string here = to_string(photo->here);
  return photo->percent == 0 || photo->here == PhotoHere::whole
             ? here
             : here + ", " + std::to_string(photo->percent) + " %";
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
void fields(Io& io, Of<Io, FoundPhoto>& photo) {
  io.word("here", photo.here, PhotoHere::whole, [](PhotoHere here) { return to_string(here); });
  io.field("percent", photo.percent);
  io.field("bytes", photo.bytes);
  io.field("id", photo.id);
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
  if (Io::kReads || item.withdrawn) io.field("withdrawn", item.withdrawn);
  if (Io::kReads || !item.also.empty()) io.field("also", item.also);
  if (Io::kReads || item.mark) io.field("mark", item.mark);
  if (Io::kReads || item.photo) io.field("photo", item.photo);
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

template <class Io>
void fields(Io& io, Of<Io, Climber>& climber) {
  io.field("robot", climber.robot);
  io.field("may", climber.may);
  io.field("reason", climber.reason);
}

template <class Io>
void fields(Io& io, Of<Io, Staircase::Sigmas>& sigma) {
  io.field("place", sigma.place);
  io.field("heading", sigma.heading);
  io.field("rise", sigma.rise);
  io.field("run", sigma.run);
  io.field("width", sigma.width);
}

template <class Io>
void fields(Io& io, Of<Io, StairsItem>& item) {
  auto& stairs = item.stairs;
  io.field("number", item.number);
  io.field("foot", stairs.foot);
  io.field("heading", stairs.heading);
  io.field("steps", stairs.steps);
  io.field("rise", stairs.rise);
  io.field("run", stairs.run);
  io.field("width", stairs.width);
  io.field("sigma", stairs.sigma);
  if constexpr (Io::kReads) {
    if (!valid(stairs)) io.refuse("a staircase");
  } else {
    io.field("top", stairs.top());
    io.field("floor_below", stairs.floor_below());
    io.field("floor_above", stairs.floor_above());
  }
  io.field("findings", item.findings);
  io.field("robots", item.robots);
  io.word("verdict", item.verdict, Verdict::rejected, [](Verdict verdict) { return to_string(verdict); });
  io.field("note", item.note);
  io.field("fleet", item.fleet);
}

template <class Io>
void fields(Io& io, Of<Io, StairsReport>& report) {
  io.field("stairs", report.stairs);
  io.field("unreadable", report.unreadable);
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
template json json_of(const FindingCounts& counts);
template json json_of(const Robot& robot);
template json json_of(const Notice& notice);
template json json_of(const StationSummary& station);
template json json_of(const AgentRate& rate);
template json json_of(const World& world);
template json json_of(const CommandEvent& event);
template json json_of(const HealthReport& report);
template json json_of(const NetworkReport& report);
template json json_of(const FoundReport& report);
template json json_of(const StairsReport& report);

Result<HealthReport> health_of(const CommandOutcome& outcome) {
  return report_of<HealthReport>(outcome, "a health report's");
}
Result<NetworkReport> network_of(const CommandOutcome& outcome) {
  return report_of<NetworkReport>(outcome, "a network report's");
}
Result<FoundReport> findings_of(const CommandOutcome& outcome) {
  return report_of<FoundReport>(outcome, "the findings'");
}

Result<StairsReport> stairs_of(const CommandOutcome& outcome) {
  return report_of<StairsReport>(outcome, "the staircases'");
}

std::vector<std::string> climbers_of(const StairsItem& item) {
  std::vector<std::string> out;
  for (const Climber& robot : item.fleet)
    if (robot.may) out.push_back(robot.robot);
  return out;
}

std::string unreadable_text(const StairsReport& report) {
  if (report.unreadable == 0) return {};
  return std::to_string(report.unreadable) + (report.unreadable == 1 ? " staircase" : " staircases") +
         " could not be read";
}

int degrees_of(const Staircase& stairs) {
  return static_cast<int>(std::lround(stairs.heading * 180.0 / std::numbers::pi) + 360) % 360;
}

std::string findings_text_of(const FoundReport& report) {
  return json_of(report).dump(2, ' ', true, json::error_handler_t::replace) + "\n";
}

}  // namespace adit::station
