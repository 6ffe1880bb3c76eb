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
  std::string robot{};           ///< our name
  std::uint64_t epoch_start{1};  ///< random id of this start
  Duration lock_lease{300s};     ///< a lock lapses when its holder was silent so long; 0: never
  std::uint16_t protocol{1};     ///< the version we speak
  Eigen::Vector3d home{0.0, 0.0,
                       std::numeric_limits<double>::quiet_NaN()};  ///< `home` goes there; map frame, m
};

/// Everything that arrives by radio enters the robot here (rules 1 to 4, and 7 where it concerns the
/// joystick). A pure state machine: it is told the time, and tells whoever made it what to send.
class CommandInterface {
 public:
  struct Outputs {
    std::function<void(const Notice&)> notify{};
    std::function<void()> changed{};  ///< authority or stops are not what they were
    /// The supervisor is asked; an error refuses the command. Null: there is no supervisor.
    std::function<Result<void>(const std::string& component)> restart{};
    std::function<Result<void>(const std::string& component, bool automatic)> policy{};
    /// Whether what was given under that epoch is for this robot and not for another one of the same name.
    /// Null: always.
    std::function<bool(const Epoch& epoch)> is_meant{};
    /// A station gave a sign of life that is its own.
    std::function<void(const Sender& station)> accepted{};
  };

  CommandInterface(CommandParams params, Requests& requests, Outputs outputs);

  /// A station's sign of life; `protocol` is what it announced.
  void hear(const Sender& from, std::uint16_t protocol, Time now);
  /// A participant left, or its lease ran out.
  void departed(const wire::ParticipantId& participant) { stations_.leave(participant); }
  /// Does what is asked, or not, and answers.
  std::optional<Answer> handle(const Command& command, Time now);
  /// The answer to a refused sample; nothing when it was taken, or when that sender was told within a second.
  std::optional<Answer> handle(const StickSample& sample, Time now);
  /// Notices what time alone changes: the lock's lease. Once a second is often enough.
  void tick(Time now);
  /// A robot state with that stamp went out.
  void sent_stamp(std::uint64_t stamp) { gate_.sent(stamp); }
  /// The holder's stick was heard within the last second, fresh or stale: it lives on the stamps we send.
  bool stick_used(Time now) const { return stick_heard_ && now - *stick_heard_ < 1s; }
  /// The robot's own console: it can always end a lock. False when there was none.
  bool unlock_at_console();

  /// What must survive a restart of the agent.
  KeptAuthority kept() const;
  std::vector<KeptAnswers> kept_answers() const { return memory_.kept(); }
  /// Commands accepted since the start of this agent whose answers a restart must not forget.
  std::uint64_t accepted() const { return memory_.accepted(); }
  /// Comes back with it, before anything was heard: holder, lock and stops as they were, under a new epoch.
  /// Tells nobody.
  void restore(const KeptAuthority& kept, const std::vector<KeptAnswers>& answers, Time now);

  const Authority& authority() const { return authority_; }
  const StopLatches& stops() const { return stops_; }
  const StationTable& stations() const { return stations_; }

 private:
  struct Outcome {
    Reason reason{Reason::none};
    std::string text{};
  };

  Outcome judge(const Command& c, Time now);
  Outcome identify(const Sender& from, StationTable::Sign sign, Time now);
  Outcome check_holder(const Command& c) const;
  bool is_meant(const Epoch& epoch) const { return !outputs_.is_meant || outputs_.is_meant(epoch); }
  Outcome perform(const Command& c, Time now);
  Outcome take(const Command& c, Time now);
  Outcome release(const Command& c, Time now);
  Outcome grant(const Command& c, Time now);
  Outcome stop(const Command& c, Time now);
  Outcome reset(const Command& c, Time now);
  static Outcome outcome(const Result<void>& result) {
    return result ? Outcome{} : Outcome{result.reason(), result.error().text};
  }
  /// The same for what the behaviour was asked; the sender is notified of a refusal, too.
  Outcome asked(const Command& c, const Result<void>& result) const;
  Outcome judge(const StickSample& s, Time now);
  Answer answer(const Command& c, const Outcome& outcome) const;
  /// Null when nobody holds, or he was not heard.
  const Station* holders_station() const;
  bool may_be_back(const Sender& from) const;
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
