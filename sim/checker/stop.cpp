// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>

#include "sim/checker/rule.hpp"

namespace adit::sim {
namespace {

constexpr double kRestingSpeed = 0.02;   // m/s
constexpr double kRestingTurn = 0.02;    // rad/s
constexpr std::size_t kMaxLatches = 16;  // of AuthorityStatus

/// Rule 4: a stop needs no authority and is a latch: while one is set the driver gets zero, and the robot
/// comes to rest in the time its brakes need.
class Stop : public Rule {
 public:
  void see(const RobotModel& robot, const Event& event, const Report& broken) override {
    if (std::get_if<AgentStarted>(&event)) owed_.clear();
    if (const auto* note = std::get_if<NotificationSent>(&event); note && note->code == "reset") {
      std::erase_if(owed_, [&](const auto& owed) { return owed.first == note->to; });
      told_[note->to] = robot.now();
    }
    if (const auto* command = std::get_if<CommandHeard>(&event); command && command->verb == Verb::stop) {
      // A late repeat of a stop that was answered, and reset since, has no second effect.
      const bool repeat = robot.first_answer(RobotModel::key(*command)) != nullptr;
      if (robot.alive() && !stopped_since_ && !repeat) begin(robot);
    }
    if (const auto* ack = std::get_if<AckSent>(&event)) see_answer(robot, *ack, broken);
    if (const auto* status = std::get_if<AuthoritySent>(&event)) see_status(robot, *status, broken);
    if (const auto* sent = std::get_if<VelocitySent>(&event); sent && !sent->velocity.zero()) {
      if (stopped_since_ && robot.now() > *stopped_since_) broken("sent a velocity while stopped");
    }
    if (const auto* truth = std::get_if<Motion>(&event)) see_truth(robot, *truth, broken);
  }

  void settle(const RobotModel& robot, const Report& broken) override {
    while (!owed_.empty() && robot.now() - owed_.front().second > 200ms) {
      broken("did not tell " + owed_.front().first + " that a stop was reset by override");
      owed_.erase(owed_.begin());
    }
    // A refused stop (reported by see_answer), the last latch cleared, or a stop without effect before
    // the agent ended.
    if (stopped_since_ && robot.authority().start != 0 && robot.latches().empty() &&
        robot.pending().empty() && robot.now() > *stopped_since_)
      stopped_since_.reset();
  }

 private:
  void begin(const RobotModel& robot) {
    stopped_since_ = robot.now();
    const Twist2& v = robot.truth().velocity;
    const double brake = std::hypot(v.vx, v.vy) / robot.facts().max_acceleration;
    const double unwind = std::abs(v.wz) / robot.facts().max_turn_acceleration;
    at_rest_by_ = robot.now() + from_seconds(std::max(brake, unwind) * 1.1 + 0.25);
    if (robot.disturbed()) at_rest_by_ += kRecovery;
    told_moving_ = false;
  }

  void see_answer(const RobotModel& robot, const AckSent& ack, const Report& broken) {
    const RobotModel::Pending* pending = robot.answered_by(ack);
    if (!pending || pending->repeat) return;
    const CommandHeard& command = pending->command;
    const RobotModel::Heard* known = robot.heard(command.station);
    const bool name_taken = known && known->id != command.id;
    if (command.verb == Verb::stop && !ack.accepted && !name_taken)
      broken("refused a stop of " + command.station);
    if (command.verb == Verb::reset && ack.accepted && command.flag) owe(robot, *pending);
    if (command.verb == Verb::reset && ack.accepted && !command.flag) {
      const auto& latches = robot.latches();
      const bool own =
          std::find(latches.begin(), latches.end(), Latch{command.station, command.id}) != latches.end();
      if (!latches.empty() && !own) broken("a reset without override was accepted for a stop of another");
    }
  }

  // Both stations are notified: the one that stopped it and the one that clears it.
  void owe(const RobotModel& robot, const RobotModel::Pending& reset) {
    const Latch own{reset.command.station, reset.command.id};
    const auto owe_to = [&](const std::string& station) {
      // Notified already: the answer may have waited for the disk.
      const auto told = told_.find(station);
      if (told == told_.end() || told->second < reset.at) owed_.emplace_back(station, robot.now());
    };
    bool others = false;
    for (const Latch& latch : robot.latches()) {
      if (latch == own) continue;
      others = true;
      owe_to(latch.station);
    }
    if (others) owe_to(own.station);
  }

  void see_status(const RobotModel& robot, const AuthoritySent& status, const Report& broken) {
    // The first word of this start, or one before the answer that explains it.
    if (robot.authority().start == 0 || robot.ahead_of_answer(status)) return;
    const auto& set = robot.latches();
    if (set.empty() != status.stops.empty())
      return broken(set.empty() ? "published a stop that nobody set" : "published no stop while one was set");
    // Beyond the room for latches the last one stands for several stoppers.
    if (set.size() >= kMaxLatches) return;
    if (!std::is_permutation(set.begin(), set.end(), status.stops.begin(), status.stops.end()))
      broken("published other stoppers than those who stopped it");
  }

  void see_truth(const RobotModel& robot, const Motion& truth, const Report& broken) {
    if (!stopped_since_ || told_moving_ || robot.now() < at_rest_by_) return;
    const Twist2& v = truth.velocity;
    if (std::hypot(v.vx, v.vy) < kRestingSpeed && std::abs(v.wz) < kRestingTurn) return;
    told_moving_ = true;
    broken("still moves after its stop");
  }

  std::optional<Duration> stopped_since_{};
  Duration at_rest_by_{};
  bool told_moving_{};
  std::map<std::string, Duration> told_{};                ///< Last notification of a reset, by operator.
  std::vector<std::pair<std::string, Duration>> owed_{};  ///< Operators to be notified, since when.
};

}  // namespace

std::unique_ptr<Rule> make_stop_rule() { return std::make_unique<Stop>(); }

}  // namespace adit::sim
