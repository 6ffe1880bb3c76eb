// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <deque>
#include <map>
#include <optional>
#include <set>

#include "sim/checker/observation.hpp"

namespace adit::sim {

/// The time a robot is given to act on what it received: one period of its 20 Hz driver output and a bit.
inline constexpr Duration kReaction{80ms};
inline constexpr Duration kJoystickSilence{300ms};
inline constexpr Duration kOldestEcho{600ms};
inline constexpr Duration kHearing{3s};
/// Who got a name in a silence of the first keeps it so long when that one is heard again.
inline constexpr Duration kGivingBack{1s};
/// A component that failed is back, or the whole agent was started again, within this.
inline constexpr Duration kRecovery{2500ms};

/// Returns the time within which a body must be at rest that brakes for `braking` seconds with its full
/// acceleration: a tenth more, and the time until the driver has received zero and the body begins to brake.
inline Duration rest_limit(double braking) { return from_seconds(braking * 1.1 + 0.25); }

/// What the outsider concludes from all it has seen of one robot: the authority that follows from the
/// answers the robot gave, who is heard, the mode it last published, the last samples.
class RobotModel {
 public:
  explicit RobotModel(RobotFacts facts) : facts_(std::move(facts)) {}

  struct Heard {
    StationId id{};
    wire::ParticipantId participant{};
    Duration last{};
    /// Who spoke for it before, and until when.
    std::optional<std::pair<wire::ParticipantId, Duration>> former{};
  };
  /// A command that was received and is not answered yet.
  struct Pending {
    CommandHeard command{};
    Duration at{};
    bool repeat{};  ///< The same command had been received before.
  };
  /// A joystick sample that came from the holder under the authority in force.
  struct Stick {
    Twist2 stick{};
    Duration at{};
  };
  using CommandKey = std::tuple<wire::ParticipantId, StationId, std::uint64_t>;

  /// What was known when the agent, or its command component, ended.
  struct Before {
    Authority authority{};
    std::vector<Latch> latches{};
    BehaviourSent behaviour{};
    std::deque<Pending> unanswered{};  ///< Executed or not: both are valid.
    bool lock_lapsed{};                ///< The lease had run out.
    bool disk_failed{};                ///< The disk failed: the state may be lost, but must not be guessed.
  };

  void take_in(const Event& event);
  /// Whether this event is the first one of the restarted command component.
  bool begins_again(const Event& event) const;
  void set_now(Duration now) { now_ = now; }

  const RobotFacts& facts() const { return facts_; }
  Duration now() const { return now_; }
  bool alive() const { return alive_; }
  /// How long ago that was by the robot's clock, which jumps.
  Duration age(Duration then) const;
  const wire::ParticipantId& participant() const { return participant_; }
  /// The command component failed a moment ago and has not spoken since.
  bool disturbed() const { return faulted_ && now_ - *faulted_ < kRecovery; }
  /// Of the last start that was not the first.
  const std::optional<Before>& before() const { return before_; }
  const BehaviourSent& behaviour() const { return behaviour_; }
  std::optional<Duration> scanned() const { return scanned_; }
  /// When the program of mode `external` spoke last.
  std::optional<Duration> programmed() const { return programmed_; }
  bool disk_failed() const;
  /// The lock's lease ran out.
  bool lock_lapsed() const;
  /// Of the holder, by the robot's clock, s.
  double holder_silence() const;
  Duration started() const { return started_; }
  Duration died() const { return died_; }

  const Authority& authority() const { return authority_; }
  const std::vector<Latch>& latches() const { return latches_; }
  Duration holder_changed() const { return holder_changed_; }
  bool knows(const wire::ParticipantId& participant) const { return participants_.contains(participant); }
  const Heard* heard(const std::string& station) const;
  /// Whether name and id are the holder's, and come from a participant that showed itself as such.
  bool is_holder(const CommandHeard& command) const;
  bool current_epoch(std::uint64_t start, std::uint32_t counter) const {
    return start == authority_.start && counter == authority_.counter;
  }
  /// The oldest unanswered command that this answers; null when there is none.
  const Pending* answered_by(const AckSent& ack) const;
  const std::deque<Pending>& pending() const { return pending_; }
  /// Whether these commands, carried out or not, may have made `holder` of who held it before.
  static bool may_hold(const Authority& was, const std::deque<Pending>& open, const std::string& holder);
  static bool asked(const std::deque<Pending>& open, std::initializer_list<Verb> verbs);
  /// What is published differs from what the answers gave, by commands that wait for theirs: an answer may be
  /// held back until the disk has what it says.
  bool ahead_of_answer(const AuthoritySent& status) const;
  /// Those that wait, or that waited when the agent died.
  const std::deque<Pending>& unanswered() const { return alive_ ? pending_ : unanswered_; }
  const AckSent* first_answer(const CommandKey& key) const;
  static CommandKey key(const CommandHeard& c) { return {c.from, c.id, c.seq}; }

  /// As published; empty before the first BehaviourState.
  const std::string& mode() const { return mode_; }
  Duration mode_changed() const { return mode_changed_; }
  /// The published mode, or the one that it replaced in this very instant, is that.
  bool in_mode(const std::string& mode) const {
    return mode_ == mode || (mode_changed_ == now_ && mode_before_ == mode);
  }
  bool in_manual_mode() const { return mode_ == "manual" || mode_ == "smart_joystick"; }

  const std::optional<VelocitySent>& velocity() const { return velocity_; }
  Duration velocity_at() const { return velocity_at_; }
  const std::optional<Stick>& stick() const { return stick_; }
  /// The last sample that was not centred.
  const std::optional<Stick>& pushed_stick() const { return pushed_stick_; }
  /// The last sample, with motion in it, that the robot had no right to obey, and why.
  const std::optional<std::pair<std::string, Duration>>& forbidden_stick() const { return forbidden_stick_; }
  const Motion& truth() const { return truth_; }

  /// Empty when the sample may move the robot, else why it may not.
  std::string refusal(const JoystickHeard& sample) const;

 private:
  void take_in_event(const AgentStarted& e);
  void take_in_event(const AgentDied& e);
  void take_in_event(const PresenceHeard& e);
  void take_in_event(const CommandHeard& e);
  void take_in_event(const JoystickHeard& e);
  void take_in_event(const AckSent& e);
  void take_in_event(const AuthoritySent& e);
  void take_in_event(const BehaviourSent& e);
  void take_in_event(const StateSent& e);
  void take_in_event(const NotificationSent&) {}
  void take_in_event(const VelocitySent& e);
  void take_in_event(const Motion& e) { truth_ = e; }
  void take_in_event(const ComponentFaulted& e);
  void take_in_event(const DiskChanged& e);
  void take_in_event(const ScanHeard&) { scanned_ = now_; }
  void take_in_event(const OdometryHeard&) {}
  void take_in_event(const NamesakeAnswered&) {}
  void take_in_event(const BeaconHeard&) {}
  void take_in_event(const ProgramHeard& e);
  void take_in_event(const ClockJumped& e) { jumps_.emplace_back(now_, e.by); }
  void hear(const std::string& station, const StationId& id, const wire::ParticipantId& from);
  Before remember() const;
  /// The id by which the robot knows a station: it heard it, or restored it with its holder. Nil when
  /// neither.
  StationId id_of(const std::string& station) const;
  void apply(const CommandHeard& command, const AckSent& ack);

  RobotFacts facts_;
  Duration now_{}, started_{}, died_{}, holder_changed_{}, mode_changed_{}, velocity_at_{};
  bool alive_{};
  wire::ParticipantId participant_{};
  std::optional<Duration> faulted_{}, scanned_{}, programmed_{};
  bool disk_full_{};
  std::optional<Duration> disk_freed_{};
  std::optional<Before> before_{};
  BehaviourSent behaviour_{};
  Authority authority_{};
  Authority restored_{};  ///< First published authority: read from the disk.
  std::vector<Latch> latches_{};
  std::map<std::string, Heard> stations_{};
  std::map<wire::ParticipantId, std::set<std::pair<std::string, StationId>>> participants_{};
  std::deque<Pending> pending_{}, unanswered_{};  ///< `unanswered_`: at the agent's death.
  std::map<CommandKey, std::optional<AckSent>> commands_{};
  std::deque<std::pair<std::uint64_t, Duration>> stamps_{};
  std::string mode_{}, mode_before_{};
  std::optional<VelocitySent> velocity_{};
  std::optional<Stick> stick_{}, pushed_stick_{};
  std::optional<std::pair<std::string, Duration>> forbidden_stick_{};
  Motion truth_{};
  std::vector<std::pair<Duration, Duration>> jumps_{};  ///< Time and size of each jump.
};

}  // namespace adit::sim
