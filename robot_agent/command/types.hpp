// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>

#include "core/command/request.hpp"
#include "core/geometry/pose.hpp"
#include "core/result/result.hpp"
#include "core/wire/participant.hpp"
#include "robot_agent/common/goal_report.hpp"
#include "robot_agent/common/identity.hpp"
#include "robot_agent/common/notice.hpp"
#include "robot_agent/common/planned_route.hpp"

/// The message types of the command interface, independent of the generated ones:
/// robot_agent/radio/convert.cpp converts between them.
namespace adit::agent {

/// A period of unchanged authority; compared for equality only.
struct Epoch {
  std::uint64_t start{};    ///< Drawn again at each start of the agent.
  std::uint32_t counter{};  ///< Rises with every change of holder.
  bool operator==(const Epoch&) const = default;
};

struct Command {
  std::string robot{};
  Sender from{};
  Epoch epoch{};
  std::uint64_t seq{};
  command::Request request{command::verb("query")};
  std::optional<GoalReport> goal{};  ///< Of a goto; nothing: the goal could not be judged.
  std::optional<Error> invalid{};    ///< Why the arguments are refused; `request` then has only its row.
};

/// The answer to a command: exactly one for each command and repeat.
struct Answer {
  std::string station{};
  Id station_id{};
  std::uint64_t seq{};  ///< 0 for a refused stick sample.
  Reason reason{Reason::none};
  std::string text{};
  std::string holder{};
  Epoch epoch{};
  std::optional<PlannedRoute> route{};  ///< Of an accepted `plan`.
  bool accepted() const { return reason == Reason::none; }
};

struct StickSample {
  std::string robot{};
  Id station_id{};
  wire::ParticipantId participant{};
  Epoch epoch{};
  std::uint64_t seq{};
  std::uint64_t echo{};  ///< A stamp that this robot sent, ns.
  Twist2 twist{};        ///< Body frame.
  Duration waited{};     ///< From reception until the sample was handled.
};

/// The point in a command's arguments, map frame, m; z is NaN if it was not given.
inline Eigen::Vector3d place_of(const command::Request& request) {
  return {request.number("X"), request.number("Y"), request.number("Z")};
}

}  // namespace adit::agent
