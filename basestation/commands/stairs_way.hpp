// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "basestation/model/stairs.hpp"
#include "core/command/request.hpp"
#include "core/result/result.hpp"

namespace adit::station {

/// Distance of the places before and behind a staircase from its outer risers, m: half of the length of the
/// longest robot that climbs (0.45) and one position error of a goal that was reached (0.35).
inline constexpr double kClearOfStairs = 0.8;

/// The goals, in turn, of `stairs go R ID up|down`: a `goto` each. A robot that saw the staircase has it in
/// its own map and needs one goal, behind the far end; another one first drives to the near end, and sees it.
/// Errors: out_of_range (no such staircase), bad_argument (it is rejected), goal_over_stairs (the robot does
/// not climb it).
Result<std::vector<command::Request>> stairs_way(const command::Request& request, const StairsReport& report);

}  // namespace adit::station
