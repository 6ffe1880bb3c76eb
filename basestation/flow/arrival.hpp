// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>

#include "basestation/flow/flow.hpp"

namespace adit::station {

/// The flow of `goto --wait`: requests the goal, then waits until it is reached, or the robot is blocked for
/// 5 s, leaves the mode, gets another goal, or is lost for 30 s.
class Arrival final : public Flow {
 public:
  /// `order`: a goto. `answered` is called with the robot's answer to it, also if the wait ended before.
  Arrival(FlowDependencies dependencies, RobotCommand robot_command, Done answered, Done done);
  void start() override;
  void cancel(Reason reason, const std::string& text) override;

 private:
  void answered(const Answer& answer);
  void poll();
  void end(Reason reason, const std::string& text);

  RobotCommand robot_command_;
  Done on_answer_;
  std::array<double, 2> goal_;  ///< Map frame, m.
  Answer outcome_{};
  Timer timer_{};
  Time accepted_at_{};
  Time blocked_since_{};
  bool blocked_{false};
  bool seen_{false};
  std::uint32_t goal_before_{};
  std::uint32_t goal_id_{};
  std::uint64_t behaviour_before_{};
};

}  // namespace adit::station
