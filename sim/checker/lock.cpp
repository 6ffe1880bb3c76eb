#include <deque>

#include "sim/checker/rule.hpp"

namespace adit::sim {
namespace {

/// Rule 2: an unlocked robot goes to whoever asks and the former holder is told; a locked one refuses with
/// its holder's name and the holder is told who asked; a lock lapses only when its holder was silent.
class Lock : public Rule {
 public:
  void see(const RobotModel& robot, const Event& event, const Report& broken) override {
    if (const auto* ack = std::get_if<AckSent>(&event)) see_answer(robot, *ack, broken);
    if (const auto* status = std::get_if<AuthoritySent>(&event)) see_status(robot, *status, broken);
    if (const auto* note = std::get_if<NotificationSent>(&event))
      std::erase(owed_codes_, Owed{note->code, note->to, {}});
    if (std::get_if<AgentStarted>(&event) || std::get_if<AgentDied>(&event)) owed_codes_.clear();
  }

  void settle(const RobotModel& robot, const Report& broken) override {
    while (!owed_codes_.empty() && robot.now() - owed_codes_.front().since > 200ms) {
      broken("did not tell " + owed_codes_.front().to + ": " + owed_codes_.front().code);
      owed_codes_.pop_front();
    }
  }

 private:
  struct Owed {
    std::string code{}, to{};
    Duration since{};
    bool operator==(const Owed& other) const { return code == other.code && to == other.to; }
  };

  void see_answer(const RobotModel& robot, const AckSent& ack, const Report& broken) {
    const RobotModel::Pending* pending = robot.answered_by(ack);
    if (!pending || pending->repeat || pending->command.verb != Verb::take) return;
    const CommandHeard& take = pending->command;
    const Authority& before = robot.authority();
    const bool by_holder = take.station == before.holder && take.id == before.holder_id;
    const bool held_by_other = !before.holder.empty() && !by_holder;
    if (held_by_other && before.locked) {
      if (ack.accepted && !lapsed(robot))
        return broken(take.station + " took it although " + before.holder + " had locked it");
      if (ack.accepted) return owed_codes_.push_back({"taken", before.holder, robot.now()});
      if (ack.reason != Reason::locked) return;
      if (ack.holder != before.holder) broken("refused a take without the holder's name");
      owed_codes_.push_back({"asked", before.holder, robot.now()});
    } else if (!ack.accepted && ack.reason == Reason::locked) {
      broken("refused a take as locked while it was not");
    } else if (ack.accepted && held_by_other) {
      owed_codes_.push_back({"taken", before.holder, robot.now()});
    }
  }

  void see_status(const RobotModel& robot, const AuthoritySent& status, const Report& broken) {
    const Authority& known = robot.authority();
    if (known.start == 0 || known.holder != status.authority.holder ||
        known.locked == status.authority.locked)
      return;
    if (!known.locked) return broken("published a lock that nobody set");
    if (!lapsed(robot))
      broken("a lock ended after " + std::to_string(silence(robot)) + " s of its holder's silence");
  }

  /// Of the holder, s.
  static double silence(const RobotModel& robot) {
    const RobotModel::Heard* holder = robot.heard(robot.authority().holder);
    return holder ? seconds(robot.age(holder->last)) : 0.0;
  }
  /// The lock's lease ran out.
  static bool lapsed(const RobotModel& robot) {
    const double lease = robot.facts().lock_lease;
    return lease > 0.0 && silence(robot) >= lease - 0.05;
  }

  std::deque<Owed> owed_codes_{};
};

}  // namespace

std::unique_ptr<Rule> make_lock_rule() { return std::make_unique<Lock>(); }

}  // namespace adit::sim
