// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <deque>

#include "sim/checker/rule.hpp"

namespace adit::sim {
namespace {

/// Rule 2: an unlocked robot goes to the station that asks, and the former holder is notified; a locked one
/// refuses with its holder's name, and the holder is notified of the request; a lock lapses only when its
/// holder was silent.
class Lock : public Rule {
 public:
  void on_event(const RobotModel& robot, const Event& event,
                const ReportViolation& report_violation) override {
    if (const auto* ack = std::get_if<AckSent>(&event)) on_answer(robot, *ack, report_violation);
    if (const auto* status = std::get_if<AuthoritySent>(&event); status && !robot.ahead_of_answer(*status))
      on_status(robot, *status, report_violation);
    if (const auto* note = std::get_if<NotificationSent>(&event))
      if (std::erase(owed_codes_, Owed{note->code, note->to, {}}) == 0) {
        sent_codes_.push_back({note->code, note->to, robot.now()});
        if (sent_codes_.size() > 64) sent_codes_.pop_front();
      }
    if (std::get_if<AgentStarted>(&event) || std::get_if<AgentDied>(&event)) owed_codes_.clear();
  }

  void on_time(const RobotModel& robot, const ReportViolation& report_violation) override {
    while (!owed_codes_.empty() && robot.now() - owed_codes_.front().since > 200ms) {
      report_violation("did not tell " + owed_codes_.front().to + ": " + owed_codes_.front().code);
      owed_codes_.pop_front();
    }
  }

 private:
  struct Owed {
    std::string code{}, to{};
    Duration since{};
    bool operator==(const Owed& other) const { return code == other.code && to == other.to; }
  };

  // A notification between the command and its answer, which may wait for the disk, counts.
  void owe(const RobotModel& robot, const RobotModel::Pending& asked, const char* code) {
    const Owed owed{code, robot.authority().holder, robot.now()};
    const auto sent = std::find_if(sent_codes_.begin(), sent_codes_.end(),
                                   [&](const Owed& t) { return t == owed && t.since >= asked.at; });
    if (sent == sent_codes_.end())
      owed_codes_.push_back(owed);
    else
      sent_codes_.erase(sent);
  }

  void on_answer(const RobotModel& robot, const AckSent& ack, const ReportViolation& report_violation) {
    const RobotModel::Pending* pending = robot.answered_by(ack);
    if (!pending || pending->repeat || pending->command.verb != Verb::take) return;
    const CommandHeard& take = pending->command;
    const Authority& before = robot.authority();
    const bool by_holder = take.station == before.holder && take.id == before.holder_id;
    const bool held_by_other = !before.holder.empty() && !by_holder;
    if (held_by_other && before.locked) {
      if (ack.accepted && !robot.lock_lapsed())
        return report_violation(take.station + " took it although " + before.holder + " had locked it");
      if (ack.accepted) return owe(robot, *pending, "taken");
      if (ack.reason != Reason::locked) return;
      if (ack.holder != before.holder) report_violation("refused a take without the holder's name");
      owe(robot, *pending, "asked");
    } else if (!ack.accepted && ack.reason == Reason::locked) {
      report_violation("refused a take as locked while it was not");
    } else if (ack.accepted && held_by_other) {
      owe(robot, *pending, "taken");
    }
  }

  void on_status(const RobotModel& robot, const AuthoritySent& status,
                 const ReportViolation& report_violation) {
    const Authority& known = robot.authority();
    if (known.start == 0 || known.holder != status.authority.holder ||
        known.locked == status.authority.locked)
      return;
    if (!known.locked) return report_violation("published a lock that nobody set");
    if (!robot.lock_lapsed())
      report_violation("a lock ended after " + std::to_string(robot.holder_silence()) +
                       " s of its holder's silence");
  }

  std::deque<Owed> owed_codes_{}, sent_codes_{};
};

}  // namespace

std::unique_ptr<Rule> make_lock_rule() { return std::make_unique<Lock>(); }

}  // namespace adit::sim
