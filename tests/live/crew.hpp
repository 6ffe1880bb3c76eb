// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "adit/authority.h"
#include "adit/command.h"
#include "adit/discovery.h"
#include "adit/robot.h"
#include "basestation/station/station.hpp"
#include "core/wire/typed.hpp"
#include "robot_agent/agent.hpp"
#include "tests/live/net.hpp"

namespace adit::live {

/// One robot's agent on its machine; its participants stay when the agent is restarted.
class Robot {
 public:
  /// Radio and inner network are joined here. `params.tree` is found in the source tree.
  Robot(Net& net, agent::AgentParams params);
  /// A new process of the same robot: other epoch, nothing remembered.
  void restart();
  wire::Participant& radio() { return *radio_; }
  wire::Participant& inner() { return *robot_; }

 private:
  Net& net_;
  agent::AgentParams params_;
  std::unique_ptr<wire::Participant> radio_, robot_;
  std::unique_ptr<agent::Agent> agent_{};
};

/// One operator's station on its machine.
class Operator {
 public:
  Operator(Net& net, const std::string& name);
  ~Operator();
  /// Runs a command line to its end.
  station::Outcome ask(const std::string& line);
  /// The same without waiting.
  void type(const std::string& line);
  /// The process dies without a word, and is started again with the same id.
  void kill();
  void start();
  bool up() const { return station_ != nullptr; }
  /// What it knows of a robot; empty when it knows none of that name.
  station::RobotView view(const std::string& robot);
  const station::Id& id() const { return params_.id; }
  station::Station& station() { return *station_; }
  Executor& strand() { return *strand_; }
  wire::Participant& radio() { return *radio_; }

 private:
  void end();

  Net& net_;
  station::StationParams params_{};
  /// Those of killed processes: a participant that says nothing more, but did not say goodbye either.
  std::vector<std::shared_ptr<Executor>> silent_strands_{};
  std::vector<std::unique_ptr<wire::Participant>> silent_radios_{};
  std::shared_ptr<Executor> strand_{};
  std::unique_ptr<wire::Participant> radio_{};
  std::unique_ptr<station::Station> station_{};
};

/// A participant that is no station of ours: hears every topic of a robot and writes arbitrary samples.
class Foreigner {
 public:
  Foreigner(Net& net, const std::string& machine, const std::string& robot);
  ~Foreigner();
  /// A command in somebody's name, under the epoch heard last; gives the answer, or nothing after 3 s.
  std::optional<radio::Acknowledgement> ask(radio::Command command);
  void joystick(const station::Id& id, float vx);
  /// The presence of a station of that name and id.
  void announce(const std::string& name, const station::Id& id);
  radio::AuthorityStatus authority() const { return heard_.authority.get(); }
  radio::RobotState state() const { return heard_.state.get(); }
  std::vector<radio::Acknowledgement> answers() const { return heard_.answers.get(); }
  std::vector<radio::Notification> notices() const { return heard_.notices.get(); }
  void forget();
  /// True when its commands reach the robot.
  bool matched() const {
    return command_.matched() > 0 && joystick_.matched() > 0 && presence_.matched() > 0;
  }

 private:
  struct Heard {
    Shared<radio::AuthorityStatus> authority{};
    Shared<radio::RobotState> state{};
    Shared<std::vector<radio::Acknowledgement>> answers{};
    Shared<std::vector<radio::Notification>> notices{};
  };

  Net& net_;
  std::string robot_;
  Heard heard_{};
  std::shared_ptr<Executor> strand_;
  std::unique_ptr<wire::Participant> radio_;
  wire::Writer<radio::Command> command_{};
  wire::Writer<radio::Joystick> joystick_{};
  wire::Writer<radio::Presence> presence_{};
  std::vector<std::unique_ptr<wire::RawReader>> readers_{};
  std::uint64_t seq_{}, stick_seq_{};
};

/// A station id that belongs to that text.
station::Id id_of(const std::string& text);

}  // namespace adit::live
