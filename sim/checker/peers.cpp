// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <optional>
#include <vector>

#include "sim/checker/rule.hpp"

namespace adit::sim {
namespace {

/// A follower's predecessor was heard within this, and a reaction.
constexpr Duration kPredecessorTimeout = 12s;
/// A robot that made way stops when it was not asked for this long, and a reaction.
constexpr Duration kAskLifetime = 5s;

/// Rule 8: peers need permission. A robot moves in convoy_follow only by a place in a convoy that its present
/// holder gave it, and while it hears a robot that the holder named before it; in get_out only while its
/// present holder allows it, not from a stop until a request after the reset, and while a robot asks it to
/// make way.
class PeersNeedPermission : public Rule {
 public:
  void on_event(const RobotModel& robot, const Event& event,
                const ReportViolation& report_violation) override {
    if (const auto* beacon = std::get_if<BeaconHeard>(&event)) {
      heard_[beacon->robot] = robot.now();
      const auto& asks = beacon->asks;
      if (std::find(asks.begin(), asks.end(), robot.facts().name) != asks.end()) asked_ = robot.now();
    }
    if (const auto* ack = std::get_if<AckSent>(&event)) on_answer(robot, *ack);
    if (const auto* sent = std::get_if<VelocitySent>(&event)) {
      on_velocity(robot, *sent, report_violation);
      watch_yield(robot, *sent, report_violation);
    }
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
    const bool no_holder = other_holder || command.verb == Verb::release || command.verb == Verb::grant;
    if (command.verb == Verb::yield) yields_ = command.text == "on";
    if (no_holder) yields_ = false;
    const bool was_stopped = !robot.latches().empty();
    if (command.verb == Verb::stop || (command.verb == Verb::reset && was_stopped)) asleep_ = true;
    if (command.verb == Verb::yield || command.verb == Verb::mode || command.verb == Verb::go_to ||
        command.verb == Verb::join)
      asleep_ = false;
  }

  void watch_yield(const RobotModel& robot, const VelocitySent& sent,
                   const ReportViolation& report_violation) {
    const bool clears = robot.alive() && robot.mode() == "get_out" && !sent.velocity.zero();
    if (!clears) {
      yield_reported_ = false;
      return;
    }
    const bool pending = RobotModel::asked(robot.pending(), {Verb::yield, Verb::mode, Verb::go_to});
    const bool allowed = (yields_ && !asleep_) || pending;
    const bool asked = asked_ && robot.age(*asked_) <= kAskLifetime + kReaction;
    if ((allowed && asked) || std::exchange(yield_reported_, true)) return;
    report_violation(allowed ? "moved in get_out and no robot asks it to make way"
                             : "moved in get_out without the permission of its holder");
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
      follow_reported_ = false;
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
    if (hears || std::exchange(follow_reported_, true)) return;
    report_violation(ahead.empty() ? "moved in convoy_follow without a place that its holder gave it"
                                   : "moved in convoy_follow and hears no robot before it");
  }

  std::map<std::string, Duration> heard_{};  ///< Last beacon of each robot.
  std::vector<std::string> ahead_{};         ///< Robots before this one; empty: it has no place.
  bool follow_reported_{};
  bool yields_{}, asleep_{};         ///< Its holder's permission, which sleeps after a stop and a reset.
  std::optional<Duration> asked_{};  ///< A robot asked it last.
  bool yield_reported_{};
};

}  // namespace

std::unique_ptr<Rule> make_peers_rule() { return std::make_unique<PeersNeedPermission>(); }

}  // namespace adit::sim
