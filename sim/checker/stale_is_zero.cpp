// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "sim/checker/rule.hpp"

namespace adit::sim {
namespace {

constexpr Duration kLongestGap{120ms};  // between two cmd_vel of a living agent; 50 ms is its period
constexpr Duration kLongestGapOfAFailure{350ms};  // until the supervisor sends zero in its stead
constexpr Duration kPlanSilence{500ms};           // without a scan no plan is fresh
constexpr Duration kProgramSilence{500ms};        // of what steers in mode external
constexpr Duration kStartUp{500ms};               // until the first cmd_vel of a new agent
constexpr Duration kParentReaction{60ms};         // from an agent's death to its parent's zero
constexpr Duration kStickRelease{1s};             // silence after which a manual mode falls to hold
constexpr Duration kCentredRest{2500ms};          // a robot brakes in less from its highest speed

/// Rule 6: when the joystick, or the program of mode external, falls silent the driver is sent zero,
/// actively, and the mode then falls to hold; the driver is never left without a word; a dead agent's parent
/// sends zero.
class StaleIsZero : public Rule {
 public:
  void on_event(const RobotModel& robot, const Event& event,
                const ReportViolation& report_violation) override {
    if (std::get_if<AgentStarted>(&event)) gap_reported_ = mode_reported_ = false;
    if (std::get_if<AgentDied>(&event)) zero_after_death_ = death_reported_ = false;
    if (const auto* sent = std::get_if<VelocitySent>(&event))
      on_velocity(robot, sent->velocity, report_violation);
  }

  void on_time(const RobotModel& robot, const ReportViolation& report_violation) override {
    if (robot.alive()) {
      const Duration last = std::max(robot.velocity_at(), robot.started() + kStartUp);
      const bool gap = robot.now() - last > (robot.disturbed() ? kLongestGapOfAFailure : kLongestGap);
      if (gap && !gap_reported_) report_violation("left its driver without a command for 120 ms");
      gap_reported_ = gap;
      if (!robot.disturbed()) watch_mode(robot, report_violation);
    } else if (robot.died() != Duration{} && !zero_after_death_ && !death_reported_ &&
               robot.now() - robot.died() > kParentReaction) {
      death_reported_ = true;
      report_violation("no zero was sent when the agent died");
    }
  }

 private:
  void on_velocity(const RobotModel& robot, const Twist2& velocity, const ReportViolation& report_violation) {
    if (!robot.alive()) {
      if (robot.now() == robot.died()) return;  // the agent's own last word
      if (velocity.zero())
        zero_after_death_ = true;
      else
        report_violation("a velocity was sent for a dead agent");
      return;
    }
    if (velocity.zero() || robot.mode_changed() == robot.now()) return;
    const bool external = robot.mode() == "external";
    const bool planned = external || robot.mode() == "waypoint" || robot.mode() == "explore" ||
                         robot.mode() == "smart_joystick";
    if (planned && (!robot.scanned() || robot.now() - *robot.scanned() > kPlanSilence + kReaction))
      report_violation("sent a velocity in " + robot.mode() + " without a scan for more than 500 ms");
    const auto& program = robot.programmed();
    if (external && (!program || robot.now() - *program > kProgramSilence + kReaction))
      report_violation("sent a velocity in external with a program silent for more than 500 ms");
    if (!robot.in_manual_mode()) return;
    const auto& stick = robot.stick();
    if (!stick || robot.now() - stick->at > kJoystickSilence + kReaction) {
      report_violation("sent a velocity in " + robot.mode() + " with a joystick silent for more than 300 ms");
    } else if (const auto& pushed = robot.pushed_stick();
               !pushed || robot.now() - pushed->at > kCentredRest) {
      report_violation("sent a velocity in " + robot.mode() + " with a centred stick");
    }
  }

  void watch_mode(const RobotModel& robot, const ReportViolation& report_violation) {
    const bool manual = robot.in_manual_mode(), external = robot.mode() == "external";
    const Duration source = external        ? robot.programmed().value_or(Duration{})
                            : robot.stick() ? robot.stick()->at
                                            : Duration{};
    const Duration silence = robot.now() - std::max(source, robot.mode_changed());
    const bool overdue = (manual && silence > kStickRelease + 2 * kReaction) ||
                         (external && silence > kProgramSilence + 2 * kReaction);
    if (overdue && !mode_reported_)
      report_violation("stays in " + robot.mode() + " without " + (external ? "its program" : "a joystick"));
    mode_reported_ = overdue;
  }

  bool gap_reported_{}, mode_reported_{}, death_reported_{};
  bool zero_after_death_{true};
};

}  // namespace

std::unique_ptr<Rule> make_stale_is_zero_rule() { return std::make_unique<StaleIsZero>(); }

}  // namespace adit::sim
