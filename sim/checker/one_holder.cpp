// SPDX-License-Identifier: Apache-2.0
#include "sim/checker/rule.hpp"

namespace adit::sim {
namespace {

std::string describe_epoch(std::uint32_t counter) { return "epoch " + std::to_string(counter); }

std::string said(const AckSent& ack) { return ack.accepted ? "accepted" : std::string(name(ack.reason)); }

bool needs_holder(Verb verb) {
  return verb != Verb::take && verb != Verb::stop && verb != Verb::query && verb != Verb::plan;
}

/// Rule 1: a command counts only with the holder's identity, the current epoch and a new sequence number;
/// every change of holder raises the epoch; a repeat gets its first answer again. Of two robots of one name
/// one obeys.
class OneHolder : public Rule {
 public:
  void on_event(const RobotModel& robot, const Event& event,
                const ReportViolation& report_violation) override {
    if (const auto* command = std::get_if<CommandHeard>(&event)) on_command(*command);
    if (const auto* other = std::get_if<NamesakeAnswered>(&event); other && other->accepted)
      obey(other->id, other->seq, Obeyed::other, report_violation);
    if (const auto* ack = std::get_if<AckSent>(&event); ack && ack->accepted)
      obey(ack->id, ack->seq, Obeyed::own, report_violation);
    if (const auto* ack = std::get_if<AckSent>(&event)) on_answer(robot, *ack, report_violation);
    if (const auto* status = std::get_if<AuthoritySent>(&event); status && !robot.ahead_of_answer(*status))
      on_status(robot, status->authority, report_violation);
    if (const auto* sent = std::get_if<VelocitySent>(&event))
      on_velocity(robot, sent->velocity, report_violation);
  }

 private:
  enum class Obeyed { nobody, own, other, both };

  // A restarted station counts from 1 again.
  void on_command(const CommandHeard& command) {
    if (!needs_holder(command.verb) && command.verb != Verb::take) return;
    auto& [from, by] = obeyed_[{command.id, command.seq}];
    if (from != command.from) by = Obeyed::nobody;
    from = command.from;
  }

  void obey(const StationId& station, std::uint64_t seq, Obeyed by, const ReportViolation& report_violation) {
    const auto command = obeyed_.find({station, seq});
    if (command == obeyed_.end()) return;
    Obeyed& before = command->second.second;
    if (before == by || before == Obeyed::both) return;
    if (before != Obeyed::nobody) {
      report_violation("command " + std::to_string(seq) + " was obeyed by another robot of its name, too");
      by = Obeyed::both;
    }
    before = by;
  }

  void on_answer(const RobotModel& robot, const AckSent& ack, const ReportViolation& report_violation) {
    if (ack.seq == 0) return;
    const RobotModel::Pending* pending = robot.answered_by(ack);
    if (!pending)
      return report_violation("answered command " + std::to_string(ack.seq) + " of " + ack.station +
                              " that it never received");
    const CommandHeard& command = pending->command;
    if (const AckSent* first = robot.first_answer(RobotModel::key(command))) {
      // What was accepted is answered so after a restart, too, or refused as too old. A refusal had no
      // effect, and need not be stored: another one will do.
      const bool other_refusal =
          robot.before() && !ack.accepted && (!first->accepted || ack.reason == Reason::stale_sequence);
      if (!other_refusal && (first->accepted != ack.accepted || first->reason != ack.reason))
        report_violation("a repeat of command " + std::to_string(ack.seq) + " of " + ack.station +
                         " got another answer: " + said(*first) + ", then " + said(ack));
      return;
    }
    if (!ack.accepted) return;
    if (needs_holder(command.verb)) {
      if (!robot.is_holder(command))
        report_violation("obeyed a command of " + command.station + ", who does not hold it, but '" +
                         robot.authority().holder + "'");
      else if (!robot.current_epoch(command.start, command.counter))
        report_violation("obeyed a command of " + describe_epoch(command.counter) + " in " +
                         describe_epoch(robot.authority().counter));
    }
    const RobotModel::Heard* known = robot.heard(command.station);
    if (command.verb == Verb::take && known && known->id != command.id && robot.age(known->last) < kHearing)
      report_violation("was taken under the name " + command.station +
                       " by another station than the one heard");
    on_transition(robot, command, ack, report_violation);
  }

  void on_transition(const RobotModel& robot, const CommandHeard& command, const AckSent& ack,
                     const ReportViolation& report_violation) {
    const Authority& before = robot.authority();
    const bool first_of_start = before.start == 0;
    bool changes = command.verb == Verb::release;
    std::string holder = before.holder;
    if (command.verb == Verb::take) {
      changes = command.station != before.holder || command.id != before.holder_id;
      holder = command.station;
    }
    if (command.verb == Verb::release) holder.clear();
    if (command.verb == Verb::grant) {
      changes = command.text != before.holder;
      holder = command.text;
    }
    if (first_of_start) return;
    if (ack.holder != holder)
      report_violation("says that '" + ack.holder + "' holds it where '" + holder + "' should");
    if (ack.start != before.start)
      report_violation("changed the start of its epoch while running");
    else if (changes && ack.counter == before.counter)
      report_violation("changed its holder without raising the epoch");
    else if (ack.counter < before.counter)
      report_violation("its epoch went back");
    else if (!changes && command.verb != Verb::grant && ack.counter != before.counter)
      report_violation("raised the epoch without a change of holder");
  }

  void on_status(const RobotModel& robot, const Authority& now, const ReportViolation& report_violation) {
    const Authority& known = robot.authority();
    if (known.start == 0) {  // the first word of this start
      if (const auto& before = robot.before(); before && now.start == before->authority.start)
        report_violation("kept its epoch through a restart");
      return;
    }
    if (now.holder != known.holder || now.holder_id != known.holder_id)
      report_violation("published holder '" + now.holder + "' where its answers gave '" + known.holder + "'");
    else if (now.start != known.start || now.counter != known.counter)
      report_violation("published " + describe_epoch(now.counter) + " where its answers gave " +
                       describe_epoch(known.counter));
  }

  // Motion in a manual mode that no sample of the holder explains, but one of somebody else does.
  void on_velocity(const RobotModel& robot, const Twist2& velocity, const ReportViolation& report_violation) {
    const auto& forbidden = robot.forbidden_stick();
    if (velocity.zero() || !forbidden || robot.now() - forbidden->second > kJoystickSilence) return;
    const auto& pushed = robot.pushed_stick();
    if (pushed && robot.now() - pushed->at < 2s) return;
    if (!robot.in_mode("manual") && !robot.in_mode("smart_joystick")) return;
    report_violation("moved by a joystick sample it must not obey: " + forbidden->first);
  }

  std::map<std::pair<StationId, std::uint64_t>, std::pair<wire::ParticipantId, Obeyed>> obeyed_{};
};

}  // namespace

std::unique_ptr<Rule> make_one_holder_rule() { return std::make_unique<OneHolder>(); }

}  // namespace adit::sim
