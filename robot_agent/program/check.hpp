// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "core/time/time.hpp"
#include "core/wire/fastdds/fastdds_participant.hpp"
#include "robot_agent/program/robot_config.hpp"

namespace adit::agent {

struct CheckParams {
  std::string file{};  ///< The robot's file, for the lines to change.
  Duration standing{10s};
  Duration turning{60s};  ///< How long the turn may take; 0: none is asked for.
};

/// `robot_agent check`: listens to the drivers of a robot that stands and then turns, and prints a line for
/// each property of its sensors. It sends nothing: the operator turns the robot by its own remote control.
///
/// Returns the exit status: 0 all lines are OK, 1 some are wrong, 2 it cannot be read or opened.
int check_sensors(const RobotConfig& config, const wire::FastDdsParams& robot, const CheckParams& params);

}  // namespace adit::agent
