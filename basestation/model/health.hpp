// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "basestation/model/outcome.hpp"
#include "core/result/result.hpp"

namespace adit::station {

enum class ComponentPhase : std::uint8_t { starting, up, waiting, failed, hung };

/// A component of a robot's agent, as its health report states it.
struct ComponentView {
  std::string name{};
  ComponentPhase phase{ComponentPhase::starting};
  bool healthy{};
  bool automatic{};    ///< Restarts automatically.
  float silent_for{};  ///< In s.
  std::uint32_t restarts{};
  std::uint32_t hung{};  ///< Number of threads that it left behind.
  std::string text{};    ///< Why it failed, or a remark.
  bool operator==(const ComponentView&) const = default;
};

struct RobotHealth {
  std::string robot{};
  std::vector<ComponentView> components{};  ///< Empty: no health report was heard.
  bool operator==(const RobotHealth&) const = default;
};

/// The answer to `health`.
struct HealthReport {
  std::vector<RobotHealth> robots{};
  bool operator==(const HealthReport&) const = default;
};

/// Readable word for a phase: "up", "FAILED", ...
const char* word(ComponentPhase phase);

/// Reads the outcome of `health`. Errors: malformed; no_answer for an outcome that is no success.
Result<HealthReport> health_of(const CommandOutcome& outcome);

}  // namespace adit::station
