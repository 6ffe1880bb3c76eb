// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <string>

#include "core/result/reason.hpp"

namespace adit::agent {

/// The judgement of the goal of a `goto` when it arrives, from the robot's map.
struct GoalReport {
  /// A reason from goal_occupied to goal_not_connected, or goal_over_stairs, refuses the goal; goal_unseen
  /// does not; none: the robot can stand there.
  Reason reason{Reason::none};
  std::string text{};
  Eigen::Vector3d place{0, 0,
                        0};  ///< The goal, or the place that replaces it, map frame, m; z NaN: not given.
};

}  // namespace adit::agent
