// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "basestation/model/robot.hpp"

/// Values in words, the same in every front end.
namespace adit::station {

/// The value with so many digits after the point; "-" if it is not finite or too large to mean anything, and
/// no minus sign before zero.
std::string fixed(double value, int decimals);
/// A code in words: "goal_missing" as "goal missing".
std::string code_text(std::string code);
/// A robot that does not know where it is states this standard deviation, the largest there is, m.
inline constexpr double kUnknownPlace = 65.0;
/// The size: "0.90 x 0.60 x 0.50 m"; "-" if unknown.
std::string size_text(const Size& size);
/// What the robot can do at most: "1.0 m/s, 1.5 rad/s, steps of 0.10 m, no stairs".
std::string limits_text(const Robot& robot);
/// What a robot does that drives to no goal: "driven by hand", "follows r1", "moves without a goal"; empty:
/// it is stationary.
std::string motion_text(const Robot& robot);
/// Why the robot does not move, in words; empty: nothing keeps it.
std::string standstill_text(const Robot& robot);
/// What the robot does about what is in its way; empty: nothing is.
std::string recovery_text(RecoveryState state);
/// What it explored: "exploring, 120 m3, about 40%, 3 frontiers left, 0 out of reach".
std::string exploration_text(const contract::Exploration& exploration);
/// An area with its kind, corners (m) and heights (m).
std::string area_text(const Area& area);

}  // namespace adit::station
