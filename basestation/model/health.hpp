// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "basestation/model/outcome.hpp"
#include "core/contract/robot.hpp"
#include "core/result/result.hpp"

namespace adit::station {

using contract::ComponentHealth;

struct RobotHealth {
  std::string robot{};
  std::vector<ComponentHealth> components{};  ///< Empty: no health report was heard.
  bool operator==(const RobotHealth&) const = default;
};

/// The answer to `health`.
struct HealthReport {
  std::vector<RobotHealth> robots{};
  bool operator==(const HealthReport&) const = default;
};

/// Readable word for a state: "up", "FAILED", ...
const char* word(PartState state);

/// Reads the outcome of `health`. Errors: malformed; no_answer for an outcome that is no success.
Result<HealthReport> health_of(const CommandOutcome& outcome);

}  // namespace adit::station
