// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "basestation/model/counts.hpp"
#include "core/contract/command.hpp"
#include "core/result/reason.hpp"
#include "core/time/time.hpp"

namespace adit::station {

/// A command for one robot.
struct RobotCommand {
  std::string robot{};
  command::Request request{command::verb("query")};

  std::string_view name() const { return request.info->name; }
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
  std::optional<contract::PlannedRoute> route{};  ///< Of an accepted `plan`.
  Duration latency{};                             ///< From the first transmission to the answer.
};

}  // namespace adit::station
