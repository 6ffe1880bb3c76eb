#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <string>

#include "core/result/reason.hpp"
#include "core/time/time.hpp"

namespace adit::station {

/// What goes to a robot as radio::Command; in the order of radio::CommandKind.
enum class Kind : std::uint8_t {
  take,
  release,
  lock,
  unlock,
  grant,
  stop,
  reset,
  mode,
  go_to,
  query,
  restart,
  policy,
  plan
};
const char* to_string(Kind kind);

struct Order {
  std::string robot{};
  Kind kind{Kind::query};
  std::string text{};  ///< mode: its name; grant: the operator; restart, policy: the component
  std::array<double, 3> position{0.0, 0.0,
                                 std::numeric_limits<double>::quiet_NaN()};  ///< goto, plan: map frame, m
  bool flag{};  ///< reset: override; policy: automatic
};

/// How an order ended: the robot's answer, or why none came.
struct Answer {
  std::string robot{};
  std::string command{};  ///< kind, or the command line's verb where the station itself answers
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
