// SPDX-License-Identifier: Apache-2.0
#include "tests/live/crew.hpp"

#include <cmath>

#include "core/wire/topics.hpp"
#include "tests/folders/folders.hpp"

namespace adit::live {

using namespace std::chrono_literals;

Robot::Robot(Net& net, agent::AgentParams params)
    : net_(net),
      params_(std::move(params)),
      radio_(net.join_radio(params_.name)),
      robot_(net.join_robot(params_.name)) {
  params_.tree = source_folder() + "/config/trees/robot.xml";
  restart();
}

void Robot::restart() {
  agent_.reset();
  ++params_.seed;
  agent_ = std::make_unique<agent::Agent>(params_, net_.machine(params_.name), *radio_, *robot_);
  if (const auto started = agent_->start(); !started) throw std::runtime_error(started.error().text);
}

Operator::Operator(Net& net, const std::string& name) : net_(net) {
  params_.name = name;
  params_.id = id_of(name);
  params_.presence = 200ms;  // the robot knows all stations soon
  start();
}

Operator::~Operator() { end(); }

void Operator::start() {
  ++params_.seed;
  strand_ = net_.machine(params_.name).strand("station");
  radio_ = net_.join_radio(params_.name);
  Result<void> started{};
  net_.on(*strand_, [&] {
    station_ = std::make_unique<station::Station>(params_, *strand_, *radio_);
    started = station_->start();
  });
  if (!started) throw std::runtime_error(started.error().text);
}

void Operator::end() {
  if (station_) net_.on(*strand_, [&] { station_.reset(); });
}

void Operator::kill() {
  net_.silence(params_.name);
  end();
  silent_strands_.push_back(std::move(strand_));
  silent_radios_.push_back(std::move(radio_));
}

void Operator::type(const std::string& line) {
  net_.on(*strand_, [&] { station_->execute(line, [](const station::Outcome&) {}); });
}

station::Outcome Operator::ask(const std::string& line) {
  const auto outcome = std::make_shared<Shared<std::optional<station::Outcome>>>();
  net_.on(*strand_, [&] {
    station_->execute(line, [outcome](const station::Outcome& ended) {
      outcome->use([&](auto& value) { value = ended; });
    });
  });
  if (!net_.until([&] { return outcome->get().has_value(); }, 60s))
    throw std::runtime_error("'" + line + "' did not end within 60 s");
  return *outcome->get();
}

station::RobotView Operator::view(const std::string& robot) {
  station::RobotView view{};
  net_.on(*strand_, [&] {
    if (const auto* known = station_->fleet().robot(robot)) view = *known;
  });
  return view;
}

Foreigner::Foreigner(Net& net, const std::string& machine, const std::string& robot)
    : net_(net),
      robot_(robot),
      strand_(net.machine(machine).strand("foreigner")),
      radio_(net.join_radio(machine)) {
  command_ = wire::Writer<radio::Command>::make(*radio_, wire::topics::kCommand, robot).value();
  joystick_ = wire::Writer<radio::Joystick>::make(*radio_, wire::topics::kJoystick, robot).value();
  presence_ = wire::Writer<radio::Presence>::make(*radio_, wire::topics::kPresence).value();
  const auto keep = [&]<class T, class F>(const wire::Topic<T>& topic, F store) {
    readers_.push_back(
        wire::make_reader(*radio_, topic, *strand_, [this, store](const T& sample, const wire::SampleInfo&) {
          if (sample.robot() == robot_) store(heard_, sample);
        }).value());
  };
  keep(wire::topics::kAuthority, [](Heard& heard, const radio::AuthorityStatus& sample) {
    heard.authority.use([&](auto& value) { value = sample; });
  });
  keep(wire::topics::kRobotState, [](Heard& heard, const radio::RobotState& sample) {
    heard.state.use([&](auto& value) { value = sample; });
  });
  keep(wire::topics::kAcknowledgement, [](Heard& heard, const radio::Acknowledgement& sample) {
    heard.answers.use([&](auto& value) { value.push_back(sample); });
  });
  keep(wire::topics::kNotification, [](Heard& heard, const radio::Notification& sample) {
    heard.notices.use([&](auto& value) { value.push_back(sample); });
  });
}

Foreigner::~Foreigner() { readers_.clear(); }

std::optional<radio::Acknowledgement> Foreigner::ask(radio::Command command) {
  command.robot(robot_);
  command.epoch(authority().epoch());
  command.seq(++seq_);
  std::optional<radio::Acknowledgement> answer;
  const auto answered = [&] {
    for (const auto& each : answers())
      if (each.seq() == command.seq() && each.station_id() == command.station_id() &&
          each.station() == command.station())
        answer = each;
    return answer.has_value();
  };
  // As a station does: until it is acknowledged.
  for (int i = 0; i < 30 && !answer; ++i) {
    (void)command_.write(command);
    net_.until(answered, 100ms);
  }
  return answer;
}

void Foreigner::joystick(const station::Id& id, float vx) {
  radio::Joystick sample;
  sample.robot(robot_);
  sample.station_id(id);
  sample.epoch(authority().epoch());
  sample.seq(++stick_seq_);
  sample.echo(state().stamp());
  sample.vx(vx);
  (void)joystick_.write(sample);
}

void Foreigner::announce(const std::string& name, const station::Id& id) {
  radio::Presence presence;
  presence.name(name);
  presence.kind(radio::AGENT_STATION);
  presence.id(id);
  presence.protocol(agent::kProtocolVersion);
  (void)presence_.write(presence);
}

void Foreigner::forget() {
  heard_.answers.use([](auto& value) { value.clear(); });
  heard_.notices.use([](auto& value) { value.clear(); });
}

station::Id id_of(const std::string& text) {
  station::Id id{};
  for (std::size_t i = 0; i < text.size(); ++i)
    id[i % id.size()] = static_cast<std::uint8_t>(id[i % id.size()] * 31 + text[i]);
  return id;
}

}  // namespace adit::live
