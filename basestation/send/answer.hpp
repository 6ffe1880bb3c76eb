#pragma once
#include <cstdint>
#include <string>
#include <string_view>

#include "core/command/request.hpp"
#include "core/result/reason.hpp"
#include "core/time/time.hpp"

namespace adit::station {

/// A command for one robot.
struct Order {
  std::string robot{};
  command::Request request{command::verb("query")};

  std::string_view name() const { return request.info->name; }
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
  Duration latency{};  ///< from the first sending to the answer
};

/// Commands of this station since its start; repeats are not commands.
struct Counts {
  std::uint64_t sent{}, repeats{}, accepted{}, refused{}, unanswered{};
};

}  // namespace adit::station
