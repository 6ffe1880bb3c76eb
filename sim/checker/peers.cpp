// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <vector>

#include "sim/checker/rule.hpp"

namespace adit::sim {
namespace {

/// A follower's predecessor was heard within this, and a reaction.
constexpr Duration kPredecessorTimeout = 12s;

/// Rule 8: peers need permission. A robot moves in convoy_follow only by a place in a convoy that its present
/// holder gave it, and while it hears a robot that the holder named before it.
class PeersNeedPermission : public Rule {
 public:
  void on_event(const RobotModel& robot, const Event& event,
                const ReportViolation& report_violation) override {
    if (const auto* beacon = std::get_if<BeaconHeard>(&event)) heard_[beacon->robot] = robot.now();
    if (const auto* ack = std::get_if<AckSent>(&event)) on_answer(robot, *ack);
    if (const auto* sent = std::get_if<VelocitySent>(&event)) on_velocity(robot, *sent, report_violation);
  }

 private:
  void on_answer(const RobotModel& robot, const AckSent& ack) {
    const RobotModel::Pending* pending = robot.answered_by(ack);
    if (!pending || !ack.accepted || robot.first_answer(RobotModel::key(pending->command))) return;
    const CommandHeard& command = pending->command;
    const Authority& before = robot.authority();
    const bool other_mode = command.verb == Verb::mode && command.text != "convoy_follow";
    const bool other_holder =
        command.verb == Verb::take && (command.station != before.holder || command.id != before.holder_id);
    if (command.verb == Verb::join)
      ahead_ = ahead_of(robot, command);
    else if (other_mode || other_holder || command.verb == Verb::go_to || command.verb == Verb::peeloff ||
             command.verb == Verb::release || command.verb == Verb::grant)
      ahead_.clear();
  }

  /// The robots that an order names before this one.
  static std::vector<std::string> ahead_of(const RobotModel& robot, const CommandHeard& command) {
    const auto own = std::find(command.words.begin(), command.words.end(), robot.facts().name);
    return {command.words.begin(), own};
  }

  void on_velocity(const RobotModel& robot, const VelocitySent& sent,
                   const ReportViolation& report_violation) {
    const bool follows = robot.alive() && robot.mode() == "convoy_follow" && !sent.velocity.zero();
    if (!follows) {
      told_ = false;
      return;
    }
    // The answer of an order that was just carried out may wait for the disk.
    std::vector<std::string> ahead = ahead_;
    for (const RobotModel::Pending& p : robot.pending())
      if (p.command.verb == Verb::join && ahead.empty()) ahead = ahead_of(robot, p.command);
    const bool hears = std::any_of(ahead.begin(), ahead.end(), [&](const std::string& name) {
      const auto heard = heard_.find(name);
      return heard != heard_.end() && robot.age(heard->second) <= kPredecessorTimeout + kReaction;
    });
    if (hears || std::exchange(told_, true)) return;
    report_violation(ahead.empty() ? "moved in convoy_follow without a place that its holder gave it"
                                   : "moved in convoy_follow and hears no robot before it");
  }

  std::map<std::string, Duration> heard_{};  ///< Last beacon of each robot.
  std::vector<std::string> ahead_{};         ///< Robots before this one; empty: it has no place.
  bool told_{};
};

}  // namespace

std::unique_ptr<Rule> make_peers_rule() { return std::make_unique<PeersNeedPermission>(); }

}  // namespace adit::sim
