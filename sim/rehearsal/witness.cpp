// SPDX-License-Identifier: Apache-2.0
#include "sim/rehearsal/witness.hpp"

#include "core/wire/topics.hpp"
#include "sim/checker/radio_decoder.hpp"

namespace adit::sim {
namespace {

constexpr std::size_t kMaxEvents = 2000;

std::uint64_t number(const wire::ParticipantId& id) {
  std::uint64_t out = 0;
  for (std::uint8_t byte : id) out = out * 257 + byte;
  return out;
}

}  // namespace

Witness::Witness(Checker& checker, std::vector<std::string> robots, std::vector<std::string> stations)
    : checker_(checker), stations_(stations.begin(), stations.end()) {
  for (std::string& robot : robots) words_.try_emplace(std::move(robot));
}

std::string Witness::robot_of(std::string_view machine) const {
  const std::string robot(machine.substr(0, machine.find('/')));
  if (!words_.contains(robot)) return {};
  if (machine.size() > robot.size() && machine != parent_machine(robot)) return {};
  return robot;
}

void Witness::obeys(const std::string& robot, agent::VelocityType type) { obeyed_[robot] = type; }

void Witness::note(const std::string& robot, Duration at, std::string text) {
  if (events_.size() < kMaxEvents) events_.push_back({at, robot, std::move(text)});
}

void Witness::see(const wire::SampleEvent& frame) {
  digest_.add(static_cast<std::uint64_t>(frame.at.count()) * 4 + static_cast<std::uint64_t>(frame.kind));
  digest_.add(number(frame.from));
  digest_.add(number(frame.to));
  digest_.add(frame.topic);
  // A sample's bytes count where they are sent; at its receivers, that it came.
  if (frame.kind == wire::SampleEvent::Kind::sent) digest_.add(frame.bytes);
  if (frame.kind == wire::SampleEvent::Kind::sent) sent(frame);
  if (frame.kind == wire::SampleEvent::Kind::delivered) delivered(frame);
}

void Witness::sent(const wire::SampleEvent& frame) {
  auto it = topics_.find(frame.topic);
  if (it == topics_.end()) it = topics_.emplace(std::string(frame.topic), TopicResult{}).first;
  ++it->second.samples;
  it->second.bytes += frame.bytes.size();

  if (stations_.contains(frame.from_name)) {
    const auto asked = decode_received(frame.topic, frame.bytes, frame.from);
    if (!asked || !std::holds_alternative<CommandHeard>(asked->event)) return;
    const auto& command = std::get<CommandHeard>(asked->event);
    Asked entry;
    if (command.verb == Verb::go_to) entry.goal = command.position;
    if (asked_.try_emplace({asked->robot, command.id, command.seq}, entry).second) ++commands_.sent;
    return;
  }
  if (of_twin(frame)) return;
  const std::string robot = robot_of(frame.from_name);
  if (robot.empty()) return;
  const auto decoded = decode_sent(frame.topic, frame.type, frame.bytes);
  if (!decoded) return;
  if (std::holds_alternative<VelocitySent>(decoded->event)) {
    const bool stamped = obeyed_[robot] == agent::VelocityType::twist_stamped;
    if (stamped != (frame.type == wire::topics::kCmdVelStamped.type)) return;
  }
  RobotWord& said = words_.at(robot);
  if (const auto* behaviour = std::get_if<BehaviourSent>(&decoded->event)) {
    if (said.heard && said.mode != behaviour->mode) note(robot, frame.at, "mode " + behaviour->mode);
    if (said.heard && said.stopped != behaviour->stopped)
      note(robot, frame.at, behaviour->stopped ? "stopped" : "stop cleared");
    said.mode = behaviour->mode;
    said.stopped = behaviour->stopped;
    said.convoy = behaviour->convoy;
    said.exploration = behaviour->exploration;
    said.drives_to_goal = behaviour->drives_to_goal;
    reported_.insert({robot, behaviour->reason});
    said.heard = true;
  }
  if (const auto* state = std::get_if<StateSent>(&decoded->event)) {
    said.pose = state->pose;
    said.pose_sent = frame.at;
  }
  if (const auto* status = std::get_if<AuthoritySent>(&decoded->event)) {
    if (said.authority.holder != status->authority.holder)
      note(robot, frame.at,
           status->authority.holder.empty() ? "released" : "held by " + status->authority.holder);
    said.authority = status->authority;
  }
  if (const auto* notice = std::get_if<NotificationSent>(&decoded->event)) {
    reported_.insert({robot, notice->reason});
    if (notified_.size() < kMaxEvents) notified_.insert({notice->to, notice->code, robot});
    if (notifications_.size() < kMaxEvents) notifications_.push_back({frame.at, robot, notice->code});
    if (notice->code == "unreachable") note(robot, frame.at, "no way to its goal");
  }
  if (const auto* ack = std::get_if<AckSent>(&decoded->event)) {
    if (!ack->accepted) reported_.insert({robot, ack->reason});
    count(robot, *ack);
  }
  checker_.observe(robot, frame.at, decoded->event);
}

bool Witness::of_twin(const wire::SampleEvent& frame) {
  const std::string robot(frame.from_name.substr(0, frame.from_name.find('/')));
  if (frame.from_name != twin_machine(robot)) return false;
  const auto decoded = decode_sent(frame.topic, frame.type, frame.bytes);
  if (!decoded || !words_.contains(robot)) return true;
  if (const auto* answer = std::get_if<AckSent>(&decoded->event))
    checker_.observe(robot, frame.at, NamesakeAnswered{answer->id, answer->seq, answer->accepted});
  return true;
}

void Witness::count(const std::string& robot, const AckSent& ack) {
  const auto it = asked_.find({robot, ack.id, ack.seq});
  if (it == asked_.end() || it->second.answered) return;
  it->second.answered = true;
  if (ack.accepted) {
    ++commands_.accepted;
    if (it->second.goal && goals_.size() < kMaxEvents)
      goals_.push_back({robot, {(*it->second.goal)[0], (*it->second.goal)[1]}});
    return;
  }
  ++commands_.refused;
  ++commands_.reasons[std::string(name(ack.reason))];
}

void Witness::delivered(const wire::SampleEvent& frame) {
  const auto it = topics_.find(frame.topic);
  if (it != topics_.end()) ++it->second.delivered;
  const std::string robot = robot_of(frame.to_name);
  if (robot.empty()) return;
  if (frame.domain != kRadioDomain && frame.to_name != robot) return;  // what its parent reads
  auto decoded = decode_received(frame.topic, frame.bytes, frame.from);
  if (decoded) checker_.observe(robot, frame.at, std::move(decoded->event));
}

void Witness::agent_started(const std::string& robot, Duration at, const wire::ParticipantId& participant) {
  words_.at(robot) = {};
  note(robot, at, "agent started");
  checker_.observe(robot, at, AgentStarted{participant});
}

void Witness::agent_died(const std::string& robot, Duration at) {
  note(robot, at, "agent died");
  checker_.observe(robot, at, AgentDied{});
}

void Witness::component_faulted(const std::string& robot, Duration at, const std::string& component) {
  checker_.observe(robot, at, ComponentFaulted{component});
}

void Witness::disk_changed(const std::string& robot, Duration at, bool full) {
  checker_.observe(robot, at, DiskChanged{full});
}

void Witness::clock_jumped(const std::string& robot, Duration at, Duration by) {
  checker_.observe(robot, at, ClockJumped{by});
}

void Witness::truth(const std::string& robot, Duration at, const Motion& truth) {
  for (double value : {truth.pose.x, truth.pose.y, truth.pose.yaw}) digest_.add(value);
  checker_.observe(robot, at, truth);
}

}  // namespace adit::sim
