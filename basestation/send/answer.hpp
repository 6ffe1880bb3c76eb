#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/command/request.hpp"
#include "core/result/reason.hpp"
#include "core/time/time.hpp"

namespace adit::station {

/// A command for one robot.
struct RobotCommand {
  std::string robot{};
  command::Request request{command::verb("query")};

  std::string_view name() const { return request.info->name; }
};

/// A route that a robot would take: its answer to `plan`. Map frame, m.
struct Route {
  double length{};
  double unknown_length{};                      ///< of it through space that was not seen yet
  std::size_t corners{};                        ///< of the complete route, start and goal included
  std::vector<std::array<double, 3>> points{};  ///< its first corners, at most 24
};

/// How an order ended: the robot's answer, or why none came.
struct Answer {
  std::string robot{};
  std::string command{};  ///< its name in the command table
  std::uint64_t seq{};    ///< 0: nothing was sent, or a stream was refused
  bool accepted{};
  bool answered{};  ///< by the robot
  Reason reason{Reason::none};
  std::string text{};
  std::string holder{};
  std::optional<Route> route{};  ///< of an accepted plan
  Duration latency{};            ///< from the first sending to the answer
};

/// Commands of this station since its start; repeats are not commands.
struct Counts {
  std::uint64_t sent{}, repeats{}, accepted{}, refused{}, unanswered{};
};

}  // namespace adit::station
