// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "sim/checker/rule.hpp"

namespace adit::sim {
namespace {

constexpr Duration kProgramSilence{500ms};  // of what steers in mode external
constexpr double kFastest = 5.0;            // m/s: no body of ours is faster
constexpr double kFastestTurn = 6.0;        // rad/s
constexpr double kOdometryNoise = 0.5;      // m, rad: between two samples

/// Rule 7: no unexpected motion. Motion needs a request that was accepted since the last start, stop,
/// fall to hold, jump of the odometry, or change of holder in a manual mode; a manual mode is entered with a
/// fresh, centred stick, external with a fresh program.
class NoSurprise : public Rule {
 public:
  void on_event(const RobotModel& robot, const Event& event,
                const ReportViolation& report_violation) override {
    if (std::get_if<AgentStarted>(&event)) on_start(robot);
    if (const auto* odometry = std::get_if<OdometryHeard>(&event)) on_odometry(robot, odometry->pose);
    // A late repeat of a stop that was answered, and reset since, has no second effect.
    if (const auto* command = std::get_if<CommandHeard>(&event);
        command && command->verb == Verb::stop && !robot.first_answer(RobotModel::key(*command)))
      revoke("a stop");
    if (const auto* presence = std::get_if<PresenceHeard>(&event)) on_presence(robot, *presence);
    if (const auto* ack = std::get_if<AckSent>(&event)) on_answer(robot, *ack, report_violation);
    if (const auto* behaviour = std::get_if<BehaviourSent>(&event))
      on_mode(robot, behaviour->mode, report_violation);
    if (const auto* behaviour = std::get_if<BehaviourSent>(&event))
      if (behaviour->mode == "hold" && granted_at_ != robot.now()) revoke("a fall to hold");
    if (const auto* sent = std::get_if<VelocitySent>(&event))
      on_velocity(robot, sent->velocity, report_violation);
  }

  void on_time(const RobotModel& robot, const ReportViolation& report_violation) override {
    // The holder changed, or his station came back: a manual mode that was on falls to hold; convoy_follow
    // and get_out when the holder changed.
    const bool on = ends_with_holder(robot);
    const bool overdue = manual_must_end_ && on && robot.now() - *manual_must_end_ > kReaction;
    if (overdue)
      report_violation("stayed in " + robot.mode() + " when its holder changed or was started again");
    if (overdue || !on) manual_must_end_.reset();
  }

 private:
  void revoke(const char* why) {
    allowed_ = false;
    why_not_ = why;
  }

  /// Whether the robot's mode ends with the authority of its holder.
  static bool ends_with_holder(const RobotModel& robot) {
    return robot.in_manual_mode() || robot.mode() == "convoy_follow" || robot.mode() == "get_out";
  }

  /// Whether the command makes the robot follow in a convoy; the first of an order leads it.
  static bool follows(const RobotModel& robot, const CommandHeard& command) {
    return command.verb == Verb::join && command.text != robot.facts().name;
  }

  // An autonomous mode goes on when it was on, or was asked for when the agent ended; a manual one does not.
  void on_start(const RobotModel& robot) {
    first_velocity_ = true;
    odometry_.reset();
    const auto autonomous = [](const std::string& mode) {
      return mode == "waypoint" || mode == "explore" || mode == "convoy_follow" || mode == "get_out";
    };
    bool goes_on = allowed_ && autonomous(robot.mode());
    for (const RobotModel::Pending& p : robot.unanswered())
      goes_on = goes_on || p.command.verb == Verb::go_to || follows(robot, p.command) ||
                (p.command.verb == Verb::mode && autonomous(p.command.text));
    if (!goes_on) revoke("a start of its agent");
  }

  void on_odometry(const RobotModel& robot, const Pose2& pose) {
    const auto before = std::exchange(odometry_, std::pair{pose, robot.now()});
    if (!before) return;
    const double time = seconds(robot.now() - before->second);
    const double way = (pose.position() - before->first.position()).norm();
    const double turn = std::fabs(wrap_angle(pose.yaw - before->first.yaw));
    if (way < kFastest * time + kOdometryNoise && turn < kFastestTurn * time + kOdometryNoise) return;
    revoke("a jump of its odometry");
    jumped_ = robot.now();
  }

  // The holder speaks as a participant that was never heard before: his station was started again, and a
  // stick that is still pushed must not go on.
  void on_presence(const RobotModel& robot, const PresenceHeard& presence) {
    const Authority& held = robot.authority();
    const bool holder = presence.station == held.holder && presence.id == held.holder_id;
    const RobotModel::Heard* before = robot.heard(presence.station);
    if (!holder || !before || before->id != presence.id || before->participant == presence.from ||
        robot.knows(presence.from))
      return;
    if (!robot.in_manual_mode()) return;
    manual_must_end_ = robot.now();
    revoke("a restart of its holder's station");
  }

  void on_answer(const RobotModel& robot, const AckSent& ack, const ReportViolation& report_violation) {
    const RobotModel::Pending* pending = robot.answered_by(ack);
    if (!pending || !ack.accepted || robot.first_answer(RobotModel::key(pending->command))) return;
    const CommandHeard& command = pending->command;
    const Authority& before = robot.authority();
    if (command.verb == Verb::go_to || follows(robot, command) ||
        (command.verb == Verb::mode && command.text != "hold")) {
      allowed_ = true;
      granted_at_ = robot.now();
      manual_must_end_.reset();
    } else if (command.verb == Verb::mode) {
      revoke("a request to hold");
    }
    if (command.verb == Verb::mode) on_entry(robot, command, report_violation);
    const bool holder_changes = (command.verb == Verb::take &&
                                 (command.station != before.holder || command.id != before.holder_id)) ||
                                command.verb == Verb::release ||
                                (command.verb == Verb::grant && command.text != before.holder);
    if (holder_changes && (ends_with_holder(robot))) {
      manual_must_end_ = robot.now();
      revoke("a change of holder");
    }
  }

  // A mode may show before its answer, which waits for the disk.
  void on_mode(const RobotModel& robot, const std::string& mode, const ReportViolation& report_violation) {
    if (mode == robot.mode()) return;
    for (const RobotModel::Pending& p : robot.pending())
      if (p.command.verb == Verb::mode && p.command.text == mode)
        return on_entry(robot, p.command, report_violation);
  }

  static void on_entry(const RobotModel& robot, const CommandHeard& command,
                       const ReportViolation& report_violation) {
    if (robot.mode() == command.text) return;
    const auto& program = robot.programmed();
    if (command.text == "external" && (!program || robot.now() - *program > kProgramSilence + 20ms))
      report_violation("entered external without a program that steers");
    if (command.text != "manual" && command.text != "smart_joystick") return;
    const auto& stick = robot.stick();
    if (!stick || robot.now() - stick->at > kJoystickSilence + 20ms)
      report_violation("entered " + command.text + " without a fresh joystick");
    else if (!stick->stick.zero())
      report_violation("entered " + command.text + " with a stick that was not centred");
  }

  void on_velocity(const RobotModel& robot, const Twist2& velocity, const ReportViolation& report_violation) {
    if (robot.alive() && std::exchange(first_velocity_, false) && !velocity.zero())
      report_violation("its first velocity after a start was not zero");
    // Rule 8 judges get_out, which no operator requests.
    if (velocity.zero() || !robot.alive() || robot.mode() == "get_out") {
      reported_ = false;
      return;
    }
    // A velocity sent in the very instant in which motion was forbidden may have come before.
    if (allowed_ || reported_ || robot.mode_changed() == robot.now()) return;
    if (jumped_ && robot.now() - *jumped_ < kReaction) return;
    if (RobotModel::asked(robot.pending(), {Verb::go_to, Verb::mode, Verb::join}))
      return;  // its answer waits for the disk
    reported_ = true;
    report_violation("moved without a new request after " + why_not_);
  }

  bool allowed_{}, reported_{}, first_velocity_{};
  std::string why_not_{"a start of its agent"};
  Duration granted_at_{-1};
  std::optional<Duration> manual_must_end_{}, jumped_{};
  std::optional<std::pair<Pose2, Duration>> odometry_{};  ///< The last sample, and when it came
};

}  // namespace

std::unique_ptr<Rule> make_no_surprise_rule() { return std::make_unique<NoSurprise>(); }

}  // namespace adit::sim
