// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "core/result/result.hpp"

namespace adit::bench {

struct TelemetryOptions {
  int seeds{1};                     ///< Rows of each world, robot and fault, from seed 1.
  std::vector<std::string> only{};  ///< Worlds, robots or faults whose rows are wanted; empty: all.
  std::string scenarios{};          ///< Existing folder for the scenario of each row that fails; empty: none.
};

/// The row `telemetry`: rehearses drives with a fault of the driver or of a sensor each, and compares the
/// poses, sigmas and healths that the operator receives from the robot with the truth. Prints a line for
/// each run and a summary. True when all rows hold. Errors: a scenario that cannot be read or run.
Result<bool> print_telemetry(const TelemetryOptions& options);

}  // namespace adit::bench
