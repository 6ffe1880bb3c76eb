// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/command/parse.hpp"
#include "robot_agent/command/command_interface.hpp"
#include "tests/agent/fake_requests.hpp"

namespace adit::agent {

/// A command interface with stations around it that type command lines.
class CommandBench {
 public:
  struct Station {
    MessageSender sender{};
    std::uint64_t seq{};
    bool up{true};
  };

  explicit CommandBench(CommandParams params = {})
      : params_(with_name(params)),
        interface_(std::make_unique<CommandInterface>(params_, requests, outputs())) {
    for (const char* op : {"op1", "op2", "op3"}) start(op);
  }

  /// A station starts: same id as ever, a new participant, presence first. The former process has been
  /// silent for a moment.
  void start(const std::string& op) {
    if (stations_.contains(op)) now += Binding::kHeartbeatTimeout;
    Station& s = stations_[op];
    s = {{op, id_of(op), next_participant()}, 0, true};
    interface_->hear(s.sender, 1, now);
  }
  /// Restarts the component with its stored state and another start id.
  void restart() {
    const StoredAuthority stored = interface_->stored();
    const std::vector<StoredAnswers> answers = interface_->stored_answers();
    ++params_.epoch_start;
    interface_ = std::make_unique<CommandInterface>(params_, requests, outputs());
    interface_->restore(stored, answers, now);
  }
  void kill(const std::string& op) { stations_.at(op).up = false; }
  void wait(Duration time) {
    for (const Time end = now + time; now < end; now += 500ms) {
      for (auto& [op, s] : stations_)
        if (s.up && op.find(':') == std::string::npos) interface_->hear(s.sender, 1, now);
      interface_->tick(now);
    }
  }

  Command command(const std::string& by, const std::string& line) {
    Station& s = station(by);
    Command c{};
    c.robot = "r1";
    c.from = s.sender;
    c.epoch = interface_->authority().epoch();
    c.seq = ++s.seq;
    const std::size_t blank = line.find(' ');  // the robot follows the first word
    const std::string rest = blank == std::string::npos ? "" : line.substr(blank);
    c.request = command::parse(line.substr(0, blank) + " r1" + rest).value();
    return c;
  }
  Answer say(const std::string& by, const std::string& line) { return send(command(by, line)); }
  Answer send(const Command& c) { return interface_->handle(c, now).value(); }

  StickSample stick(const std::string& by, Twist2 twist = {}) {
    Station& s = station(by);
    interface_->sent_stamp(to_stamp(now));
    return {{"r1", s.sender.id, interface_->authority().epoch(), ++stick_seq_, to_stamp(now), twist},
            s.sender.participant};
  }

  /// "op1", "impostor:op1" (own id) or "forger:op1" (op1's id); the latter two are made when first named.
  Station& station(const std::string& by) {
    if (!stations_.contains(by)) {
      const std::string name = by.substr(by.find(':') + 1);
      const Id id = by.starts_with("forger:") ? id_of(name) : id_of(by);
      stations_[by] = {{name, id, next_participant()}, 0, true};
    }
    return stations_.at(by);
  }
  CommandInterface& interface() { return *interface_; }

  FakeRequests requests{};
  std::vector<Notice> notices{};
  int changes{};
  Time now{Duration{1h}};

 private:
  static CommandParams with_name(CommandParams params) {
    params.robot = "r1";
    return params;
  }
  CommandInterface::Outputs outputs() {
    return {[this](const Notice& n) { notices.push_back(n); }, [this] { ++changes; }};
  }
  static Id id_of(const std::string& text) {
    Id id{};
    for (std::size_t i = 0; i < text.size(); ++i)
      id[i % id.size()] = static_cast<std::uint8_t>(id[i % 16] * 31 + text[i]);
    return id;
  }
  wire::ParticipantId next_participant() {
    wire::ParticipantId id{};
    id[0] = ++participants_;
    return id;
  }

  std::map<std::string, Station> stations_{};
  std::uint8_t participants_{};
  std::uint64_t stick_seq_{};
  CommandParams params_;
  std::unique_ptr<CommandInterface> interface_;
};

}  // namespace adit::agent
