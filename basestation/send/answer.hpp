// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "basestation/model/counts.hpp"
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
  double unknown_length{};                      ///< Length through space that was not observed yet, m.
  std::size_t corners{};                        ///< Of the complete route, start and goal included.
  std::vector<std::array<double, 3>> points{};  ///< The first corners, at most 24.
};

/// The result of a command: the robot's answer, or why there was none.
struct Answer {
  std::string robot{};
  std::string command{};  ///< Name in the command table.
  std::uint64_t seq{};    ///< 0: nothing was sent, or a stick sample was refused.
  bool accepted{};
  bool answered{};  ///< The robot answered.
  Reason reason{Reason::none};
  std::string text{};
  std::string holder{};
  std::optional<Route> route{};  ///< Of an accepted `plan`.
  Duration latency{};            ///< From the first transmission to the answer.
};

}  // namespace adit::station
