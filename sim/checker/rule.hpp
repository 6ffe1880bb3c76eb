// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <memory>
#include <string>

#include "sim/checker/robot_model.hpp"

namespace adit::sim {

/// Records a violation of the rule, described in one sentence without its subject, the robot.
using ReportViolation = std::function<void(std::string text)>;

/// One rule of docs/architecture.md, checked on one robot.
class Rule {
 public:
  virtual ~Rule() = default;
  /// Called for every event before `robot` processes it. `robot.now()` is the time of the event.
  virtual void on_event(const RobotModel& robot, const Event& event,
                        const ReportViolation& report_violation) = 0;
  /// Called when time advances, after all events up to `robot.now()` were processed.
  virtual void on_time(const RobotModel& robot, const ReportViolation& report_violation) {
    (void)robot, (void)report_violation;
  }
};

std::unique_ptr<Rule> make_one_holder_rule();     ///< Rule 1.
std::unique_ptr<Rule> make_lock_rule();           ///< Rule 2.
std::unique_ptr<Rule> make_acknowledge_rule();    ///< Rule 3.
std::unique_ptr<Rule> make_stop_rule();           ///< Rule 4.
std::unique_ptr<Rule> make_one_source_rule();     ///< Rule 5.
std::unique_ptr<Rule> make_stale_is_zero_rule();  ///< Rule 6.
std::unique_ptr<Rule> make_no_surprise_rule();    ///< Rule 7.
std::unique_ptr<Rule> make_peers_rule();          ///< Rule 8.
std::unique_ptr<Rule> make_nothing_lost_rule();   ///< Rule 9.
std::unique_ptr<Rule> make_areas_rule();          ///< Rule 10.
std::unique_ptr<Rule> make_honest_pose_rule();    ///< Rule 11.

}  // namespace adit::sim
