#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>

#include "core/command/request.hpp"
#include "core/geometry/pose.hpp"
#include "core/result/result.hpp"
#include "core/wire/participant.hpp"
#include "robot_agent/common/identity.hpp"
#include "robot_agent/common/notice.hpp"
#include "robot_agent/common/planned_route.hpp"

/// What the command interface speaks, free of generated message types: robot_agent/radio/convert.cpp
/// converts at the edge.
namespace adit::agent {

/// Who rules since when; compared for equality only.
struct Epoch {
  std::uint64_t start{};    ///< drawn anew at each start of the agent
  std::uint32_t counter{};  ///< rises with every change of holder
  bool operator==(const Epoch&) const = default;
};

struct Command {
  std::string robot{};
  Sender from{};
  Epoch epoch{};
  std::uint64_t seq{};
  command::Request request{command::verb("query")};
  std::optional<Error> invalid{};  ///< why the arguments are refused; `request` has its row alone then
};

/// Exactly one per command and repeat.
struct Answer {
  std::string station{};
  Id station_id{};
  std::uint64_t seq{};  ///< 0 for a refused stream
  Reason reason{Reason::none};
  std::string text{};
  std::string holder{};
  Epoch epoch{};
  std::optional<PlannedRoute> route{};  ///< of an accepted plan
  bool accepted() const { return reason == Reason::none; }
};

struct StickSample {
  std::string robot{};
  Id station_id{};
  wire::ParticipantId participant{};
  Epoch epoch{};
  std::uint64_t seq{};
  std::uint64_t echo{};  ///< a stamp of ours, ns
  Twist2 twist{};        ///< body frame
  Duration waited{};     ///< from its reception until it was handled
};

/// The point that a command names, map frame, m; z is NaN when it was not given.
inline Eigen::Vector3d place_of(const command::Request& request) {
  return {request.number("X"), request.number("Y"), request.number("Z")};
}

}  // namespace adit::agent
