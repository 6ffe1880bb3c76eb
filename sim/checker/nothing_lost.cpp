// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "sim/checker/rule.hpp"

namespace adit::sim {
namespace {

/// Rule 9, and the restoring half of rule 7: holder, lock, stops and goal that were acknowledged before a
/// restart are there after it. What was received and not answered may have been done or not. When the disk
/// took nothing the state may be lost as a whole: then the robot has no holder and is in `hold`.
class NothingLost : public Rule {
 public:
  void on_event(const RobotModel& robot, const Event& event,
                const ReportViolation& report_violation) override {
    if (std::get_if<AgentStarted>(&event)) behaviour_due_ = true;
    if (!robot.before()) return;
    if (const auto* status = std::get_if<AuthoritySent>(&event); status && robot.authority().start == 0)
      on_status(*robot.before(), *status, report_violation);
    if (const auto* behaviour = std::get_if<BehaviourSent>(&event);
        behaviour && std::exchange(behaviour_due_, false))
      on_behaviour(*robot.before(), *behaviour, report_violation);
  }

 private:
  using Before = RobotModel::Before;

  static bool asked(const Before& before, std::initializer_list<Verb> verbs) {
    return RobotModel::asked(before.unanswered, verbs);
  }

  void on_status(const Before& before, const AuthoritySent& now, const ReportViolation& report_violation) {
    const Authority& was = before.authority;
    lost_ = before.disk_failed && now.authority.holder.empty() && !was.holder.empty();
    if (before.disk_failed && now.authority.holder.empty()) return;  // lost, or there was none
    if (!RobotModel::may_hold(was, before.unanswered, now.authority.holder))
      return report_violation("'" + was.holder + "' held it before a restart, '" + now.authority.holder +
                              "' after it");
    const bool same = now.authority.holder == was.holder;
    const bool requested = asked(before, {Verb::lock, Verb::unlock, Verb::take, Verb::release, Verb::grant});
    if (same && now.authority.locked != was.locked && !requested && !before.lock_lapsed)
      report_violation(was.locked ? "its lock was lost in a restart" : "a restart locked it");
    if (now.authority.counter <= was.counter)
      report_violation("the counter of its epoch did not go on in a restart");
    on_stops(before, now.stops, report_violation);
  }

  static void on_stops(const Before& before, const std::vector<Latch>& now,
                       const ReportViolation& report_violation) {
    const auto has = [](const std::vector<Latch>& all, const Latch& one) {
      return std::find(all.begin(), all.end(), one) != all.end();
    };
    for (const Latch& latch : before.latches)
      if (!has(now, latch) && !asked(before, {Verb::reset}))
        report_violation("the stop of " + latch.station + " was lost in a restart");
    for (const Latch& latch : now)
      if (!has(before.latches, latch) && !asked(before, {Verb::stop}))
        report_violation("a stop of " + latch.station + " came up in a restart");
  }

  void on_behaviour(const Before& before, const BehaviourSent& now,
                    const ReportViolation& report_violation) const {
    // A mode whose source is somebody's hand or a program does not come back by itself.
    const auto steered = [](const std::string& mode) {
      return mode == "manual" || mode == "smart_joystick" || mode == "external";
    };
    const bool manual = steered(before.behaviour.mode);
    if (steered(now.mode))
      report_violation("came back in " + now.mode);
    else if (now.mode != "hold" && (manual || before.behaviour.mode == "hold") &&
             !asked(before, {Verb::go_to, Verb::mode}))
      report_violation("came back in " + now.mode + " where it was in " + before.behaviour.mode);
    if (lost_) {
      if (now.mode != "hold") report_violation("lost its state and came back in " + now.mode);
      return;
    }
    if (before.disk_failed) return;
    const bool requested = asked(before, {Verb::go_to, Verb::mode});
    if (before.behaviour.has_goal && !requested && (!now.has_goal || now.goal_id != before.behaviour.goal_id))
      report_violation("its goal was lost in a restart");
  }

  bool behaviour_due_{}, lost_{};
};

}  // namespace

std::unique_ptr<Rule> make_nothing_lost_rule() { return std::make_unique<NothingLost>(); }

}  // namespace adit::sim
