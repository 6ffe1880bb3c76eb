// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "core/result/reason.hpp"

namespace adit::station {

/// Exit codes of the programs, and of a command's outcome.
inline constexpr int kExitDone = 0;
inline constexpr int kExitRefused = 1;
inline constexpr int kExitUsage = 2;
inline constexpr int kExitNoAnswer = 3;

/// What a robot answered to a command, or that it did not.
struct RobotAnswer {
  std::string robot{};
  bool accepted{};
  bool answered{};  ///< The robot answered.
  Reason reason{Reason::none};
  std::string text{};
  std::string holder{};
  bool operator==(const RobotAnswer&) const = default;
};

/// How a command line ended, as a front end reads it.
struct CommandOutcome {
  int exit_code{};                     ///< kExitDone, ...
  std::string text{};                  ///< Readable result; lines end in a newline.
  std::string error{};                 ///< Readable refusals and reasons; lines end in a newline.
  std::string json{"{}"};              ///< The same for scripts, as one JSON object.
  std::vector<RobotAnswer> answers{};  ///< By robot, for commands to robots.
  bool operator==(const CommandOutcome&) const = default;
};

/// A command of any front end of the station began or ended.
struct CommandEvent {
  std::uint64_t id{};
  bool ended{};
  std::string line{};
  bool query{};             ///< It asks only.
  bool mine{};              ///< Of this connection.
  std::string front_end{};  ///< Which kind of program began it.
  int pid{};
  int exit_code{};
  std::string text{}, error{};
  bool operator==(const CommandEvent&) const = default;
};

}  // namespace adit::station
