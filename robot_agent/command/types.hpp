// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>
#include <string>

#include "core/contract/command.hpp"
#include "core/result/result.hpp"
#include "core/wire/participant.hpp"
#include "robot_agent/common/goal_report.hpp"
#include "robot_agent/common/identity.hpp"
#include "robot_agent/common/notice.hpp"

/// The messages of the radio contract as the command interface handles them: with the participant that sent
/// them.
namespace adit::agent {

using contract::Epoch;
using contract::PlannedRoute;
/// The answer to a command; RadioEdge adds the robot's name.
using Answer = contract::Acknowledgement;

/// A command to this robot as it arrived.
struct Command {
  std::string robot{};
  MessageSender from{};
  Epoch epoch{};
  std::uint64_t seq{};
  command::Request request{command::verb("query")};
  std::optional<GoalReport> goal{};  ///< Of a goto; nothing: the goal could not be judged.
  std::optional<Error> invalid{};    ///< Why the arguments are refused; `request` then has only its row.
};

/// A sample of a station's joystick as it arrived.
struct StickSample : contract::Joystick {
  wire::ParticipantId participant{};
  Duration waited{};  ///< From reception until the sample was handled.
};

/// The point in a command's arguments, map frame, m; z is NaN if it was not given.
inline Eigen::Vector3d place_of(const command::Request& request) {
  return {request.number("X"), request.number("Y"), request.number("Z")};
}

}  // namespace adit::agent
