// SPDX-License-Identifier: Apache-2.0
#include "sim/checker/rule.hpp"

namespace adit::sim {
namespace {

/// Rule 5: only the source that the published mode enables moves the robot, and a change of source passes
/// through zero.
class OneSource : public Rule {
 public:
  void on_event(const RobotModel& robot, const Event& event,
                const ReportViolation& report_violation) override {
    if (std::get_if<AgentStarted>(&event)) moving_in_.clear();
    const auto* sent = std::get_if<VelocitySent>(&event);
    if (!sent) return;
    if (sent->velocity.zero()) {
      moving_in_.clear();
      return;
    }
    if (robot.in_mode(moving_in_) && !moving_in_.empty()) return;  // goes on as before
    const std::string& mode = robot.mode();
    if (mode.empty() || (mode == "hold" && robot.mode_changed() != robot.now())) {
      report_violation("sent a velocity in mode hold");
    } else if (!moving_in_.empty() && moving_in_ != mode) {
      report_violation("went from " + moving_in_ + " to " + mode + " without passing zero");
    }
    moving_in_ = mode;
  }

 private:
  std::string moving_in_{};  ///< Mode of the velocities since the last zero.
};

}  // namespace

std::unique_ptr<Rule> make_one_source_rule() { return std::make_unique<OneSource>(); }

}  // namespace adit::sim
