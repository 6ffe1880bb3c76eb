// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <limits>
#include <optional>
#include <string>

#include "robot_agent/command/answer_memory.hpp"
#include "robot_agent/command/authority.hpp"
#include "robot_agent/command/requests.hpp"
#include "robot_agent/command/station_table.hpp"
#include "robot_agent/command/stick_gate.hpp"
#include "robot_agent/command/stop_latches.hpp"
#include "robot_agent/common/rate_limit.hpp"

namespace adit::agent {

struct CommandParams {
  std::string robot{};           ///< Name of this robot.
  std::uint64_t epoch_start{1};  ///< Random id of this start.
  Duration lock_lease{300s};     ///< A lock expires after its holder was silent for this long; 0: never.
  std::uint16_t protocol{1};     ///< Protocol version of this robot.
  Eigen::Vector3d home{
      0.0, 0.0, std::numeric_limits<double>::quiet_NaN()};  ///< Goal of the command `home`; map frame, m.
};

/// Judges and executes the commands and joystick samples that arrive on the radio domain (rules 1 to 4, and 7
/// for the joystick). A pure state machine: the caller passes the time, and outputs are returned or reported
/// through Outputs.
class CommandInterface {
 public:
  struct Outputs {
    std::function<void(const Notice&)> notify{};
    std::function<void()> changed{};  ///< Authority or stops changed.
    /// Asks the supervisor for a restart; an error refuses the command. Null: there is no supervisor.
    std::function<Result<void>(const std::string& component)> restart{};
    std::function<Result<void>(const std::string& component, bool automatic)> policy{};
    /// Whether a command with that epoch is for this robot and not for another one of the same name. Null:
    /// always.
    std::function<bool(const Epoch& epoch)> is_meant{};
    /// Reports a genuine heartbeat of a station.
    std::function<void(const MessageSender& station)> accepted{};
  };

  CommandInterface(CommandParams params, Requests& requests, Outputs outputs);

  /// Processes a station's heartbeat; `protocol` is the version that it announced.
  void hear(const MessageSender& from, std::uint16_t protocol, Time now);
  /// Records that a participant left, or that its lease expired.
  void departed(const wire::ParticipantId& participant) { stations_.leave(participant); }
  /// Executes or refuses a command, and returns the answer.
  std::optional<Answer> handle(const Command& command, Time now);
  /// Processes a stick sample. Returns the answer to a refused sample; nothing if the sample was accepted, or
  /// if that sender got such an answer within the last second.
  std::optional<Answer> handle(const StickSample& sample, Time now);
  /// Ends a lock whose lease expired. Call it once a second.
  void tick(Time now);
  /// Records the stamp of a robot state that was sent.
  void sent_stamp(std::uint64_t stamp) { gate_.sent(stamp); }
  /// Whether a sample of the holder's stick arrived within the last second, fresh or stale; such samples echo
  /// the stamps of the robot states sent.
  bool stick_used(Time now) const { return stick_heard_ && now - *stick_heard_ < 1s; }
  /// Ends the lock from the robot's own console, which is always permitted. Returns false if there was none.
  bool unlock_at_console();

  /// The state that must survive a restart of the agent.
  StoredAuthority stored() const;
  std::vector<StoredAnswers> stored_answers() const { return memory_.stored(holders_participant()); }
  /// Number of commands accepted since the start of this agent whose answers must survive a restart.
  std::uint64_t accepted() const { return memory_.accepted(); }
  /// Restores holder, lock and stops under a new epoch, before any message is processed. Sends no
  /// notification.
  void restore(const StoredAuthority& stored, const std::vector<StoredAnswers>& answers, Time now);

  const Authority& authority() const { return authority_; }
  const StopLatches& stops() const { return stops_; }
  const StationTable& stations() const { return stations_; }

 private:
  struct Outcome {
    Reason reason{Reason::none};
    std::string text{};
  };

  Outcome judge(const Command& c, Time now);
  Outcome identify(const MessageSender& from, StationTable::Sign sign, Time now);
  Outcome check_holder(const Command& c) const;
  bool is_meant(const Epoch& epoch) const { return !outputs_.is_meant || outputs_.is_meant(epoch); }
  Outcome perform(const Command& c, Time now);
  Outcome go_to(const Command& c, Time now);
  Outcome explore(const Command& c, Time now);
  Outcome take(const Command& c, Time now);
  Outcome release(const Command& c, Time now);
  Outcome grant(const Command& c, Time now);
  Outcome stop(const Command& c, Time now);
  Outcome reset(const Command& c, Time now);
  static Outcome outcome(const Result<void>& result) {
    return result ? Outcome{} : Outcome{result.reason(), result.error().text};
  }
  /// The same for a request to the behaviour; the sender also gets a notification of a refusal.
  Outcome asked(const Command& c, const Result<void>& result) const;
  Outcome judge(const StickSample& s, Time now);
  Answer answer(const Command& c, const Outcome& outcome) const;
  /// The holder's station; null if the robot has no holder, or the station was not heard.
  const Station* holders_station() const;
  /// The participant that sends for the holder; null: there is no holder, or it was not heard yet.
  const wire::ParticipantId* holders_participant() const;
  bool may_be_back(const MessageSender& from) const;
  void report_intruder(const std::string& name, const wire::ParticipantId& participant, Time now);
  void notify(const std::string& to, Severity severity, const char* code, Reason reason,
              std::string text) const;

  CommandParams params_;
  Requests& requests_;
  Outputs outputs_;
  StationTable stations_{};
  Authority authority_;
  StopLatches stops_{};
  AnswerMemory memory_{};
  StickGate gate_{};
  std::optional<Time> stick_heard_{};
  RateLimit<wire::ParticipantId> stream_refusals_{1s};
  RateLimit<wire::ParticipantId> intruders_{1s};
};

}  // namespace adit::agent
