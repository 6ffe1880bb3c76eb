// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>

#include "sim/checker/rule.hpp"

namespace adit::sim {
namespace {

constexpr double kRestingSpeed = 0.02;   ///< A slower body is at rest, m/s.
constexpr double kRestingTurn = 0.02;    ///< A body that turns slower is at rest, rad/s.
constexpr std::size_t kMaxLatches = 16;  ///< Number of stops that an AuthorityStatus has room for.
/// The operators must be notified within this time of a reset by override.
constexpr Duration kNotificationTimeout = 200ms;

/// Checks rule 4. A stop needs no authority. A stop is a latch: while one is set, the driver receives zero,
/// and the robot comes to rest in the time that its brakes need.
class Stop : public Rule {
 public:
  void on_event(const RobotModel& robot, const Event& event,
                const ReportViolation& report_violation) override {
    if (std::holds_alternative<AgentStarted>(event)) {
      due_notifications_.clear();
    } else if (const auto* notification = std::get_if<NotificationSent>(&event)) {
      on_notification(robot, *notification);
    } else if (const auto* command = std::get_if<CommandHeard>(&event)) {
      on_command(robot, *command);
    } else if (const auto* ack = std::get_if<AckSent>(&event)) {
      on_answer(robot, *ack, report_violation);
    } else if (const auto* status = std::get_if<AuthoritySent>(&event)) {
      on_status(robot, *status, report_violation);
    } else if (const auto* sent = std::get_if<VelocitySent>(&event)) {
      if (!sent->velocity.zero() && stopped_since_ && robot.now() > *stopped_since_)
        report_violation("sent a velocity while stopped");
    } else if (const auto* truth = std::get_if<Motion>(&event)) {
      on_truth(robot, *truth, report_violation);
    }
  }

  void on_time(const RobotModel& robot, const ReportViolation& report_violation) override {
    while (!due_notifications_.empty() &&
           robot.now() - due_notifications_.front().since > kNotificationTimeout) {
      report_violation("did not tell " + due_notifications_.front().station +
                       " that a stop was reset by override");
      due_notifications_.erase(due_notifications_.begin());
    }
    // The stop ended: its last latch was cleared, it was refused (on_answer() reports that), or the agent
    // ended before the stop had an effect.
    if (stopped_since_ && robot.authority().start != 0 && robot.latches().empty() &&
        robot.pending().empty() && robot.now() > *stopped_since_)
      stopped_since_.reset();
  }

 private:
  /// A notification that must be sent.
  struct DueNotification {
    std::string station{};
    Duration since{};  ///< Time of the reset.
  };

  void on_notification(const RobotModel& robot, const NotificationSent& notification) {
    if (notification.code != "reset") return;
    std::erase_if(due_notifications_, [&](const auto& due) { return due.station == notification.to; });
    last_notified_[notification.to] = robot.now();
  }

  void on_command(const RobotModel& robot, const CommandHeard& command) {
    if (command.verb != Verb::stop || !robot.alive() || stopped_since_) return;
    // A late repetition of an answered stop has no effect, even if that stop was reset since.
    if (!robot.first_answer(RobotModel::key(command))) begin_stop(robot);
  }

  void begin_stop(const RobotModel& robot) {
    stopped_since_ = robot.now();
    const Twist2& v = robot.truth().velocity;
    const double braking_time = std::hypot(v.vx, v.vy) / robot.facts().max_acceleration;
    const double turn_braking_time = std::abs(v.wz) / robot.facts().max_turn_acceleration;
    rest_deadline_ = robot.now() + rest_limit(std::max(braking_time, turn_braking_time));
    if (robot.disturbed()) rest_deadline_ += kRecovery;
    motion_reported_ = false;
  }

  void on_answer(const RobotModel& robot, const AckSent& ack, const ReportViolation& report_violation) {
    const RobotModel::Pending* pending = robot.answered_by(ack);
    if (!pending || pending->repeat) return;
    const CommandHeard& command = pending->command;
    if (command.verb == Verb::stop && !ack.accepted) {
      const RobotModel::Heard* known = robot.heard(command.station);
      const bool name_taken = known && known->id != command.id;
      if (!name_taken) report_violation("refused a stop of " + command.station);
    }
    if (command.verb != Verb::reset || !ack.accepted) return;
    const bool by_override = command.flag;
    if (by_override) return require_notifications(robot, *pending);
    const auto& latches = robot.latches();
    const Latch own{command.station, command.id};
    if (!latches.empty() && std::find(latches.begin(), latches.end(), own) == latches.end())
      report_violation("a reset without override was accepted for a stop of another");
  }

  /// After a reset by override, the stations whose latches it cleared and the station that sent it must be
  /// notified.
  void require_notifications(const RobotModel& robot, const RobotModel::Pending& reset) {
    const Latch own{reset.command.station, reset.command.id};
    bool clears_others = false;
    for (const Latch& latch : robot.latches()) {
      if (latch == own) continue;
      clears_others = true;
      require_notification(robot, latch.station, reset.at);
    }
    if (clears_others) require_notification(robot, own.station, reset.at);
  }

  void require_notification(const RobotModel& robot, const std::string& station, Duration reset_at) {
    // The robot sends its answer only once the new state is on the disk, so the notification may precede it.
    const auto notified = last_notified_.find(station);
    if (notified == last_notified_.end() || notified->second < reset_at)
      due_notifications_.push_back({station, robot.now()});
  }

  void on_status(const RobotModel& robot, const AuthoritySent& status,
                 const ReportViolation& report_violation) {
    // Nothing is known yet of an agent that just started. A status that precedes the answer to its command
    // is compared once that answer was sent.
    if (robot.authority().start == 0 || robot.ahead_of_answer(status)) return;
    const auto& latches = robot.latches();
    if (latches.empty() != status.stops.empty())
      return report_violation(latches.empty() ? "published a stop that nobody set"
                                              : "published no stop while one was set");
    // A full status has one entry for all stations that it has no room for.
    if (latches.size() >= kMaxLatches) return;
    if (!std::is_permutation(latches.begin(), latches.end(), status.stops.begin(), status.stops.end()))
      report_violation("the published stops are not those of the stations that stopped it");
  }

  void on_truth(const RobotModel& robot, const Motion& truth, const ReportViolation& report_violation) {
    if (!stopped_since_ || motion_reported_ || robot.now() < rest_deadline_) return;
    const Twist2& v = truth.velocity;
    if (std::hypot(v.vx, v.vy) < kRestingSpeed && std::abs(v.wz) < kRestingTurn) return;
    motion_reported_ = true;
    report_violation("still moves after its stop");
  }

  // Times are virtual times of the run.
  std::optional<Duration> stopped_since_{};
  Duration rest_deadline_{};  ///< Time by which the robot must be at rest.
  bool motion_reported_{};
  std::map<std::string, Duration> last_notified_{};  ///< Time of the last reset notification, by station.
  std::vector<DueNotification> due_notifications_{};
};

}  // namespace

std::unique_ptr<Rule> make_stop_rule() { return std::make_unique<Stop>(); }

}  // namespace adit::sim
