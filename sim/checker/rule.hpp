// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <memory>
#include <string>

#include "sim/checker/robot_model.hpp"

namespace adit::sim {

/// Says that the rule was broken, in one sentence.
using Report = std::function<void(std::string text)>;

/// One rule of docs/architecture.md watched on one robot.
class Rule {
 public:
  virtual ~Rule() = default;
  /// Called for every event before `robot` takes it in. `robot.now()` is the event's time.
  virtual void see(const RobotModel& robot, const Event& event, const Report& broken) = 0;
  /// Called when time went on: everything that happened until `robot.now()` was seen and taken in.
  virtual void settle(const RobotModel& robot, const Report& broken) { (void)robot, (void)broken; }
};

std::unique_ptr<Rule> make_one_holder_rule();     ///< Rule 1.
std::unique_ptr<Rule> make_lock_rule();           ///< Rule 2.
std::unique_ptr<Rule> make_acknowledge_rule();    ///< Rule 3.
std::unique_ptr<Rule> make_stop_rule();           ///< Rule 4.
std::unique_ptr<Rule> make_one_source_rule();     ///< Rule 5.
std::unique_ptr<Rule> make_stale_is_zero_rule();  ///< Rule 6.
std::unique_ptr<Rule> make_no_surprise_rule();    ///< Rule 7.
std::unique_ptr<Rule> make_nothing_lost_rule();   ///< Rule 9.

}  // namespace adit::sim
