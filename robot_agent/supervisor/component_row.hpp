// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "core/supervisor/restart_policy_engine.hpp"

namespace adit::agent {

/// One line of the robot's health: a component, or a part of the robot that has none (driver, disk).
struct ComponentRow {
  std::string name{};
  PartState state{PartState::up};
  bool healthy{true};
  bool automatic{true};
  /// Last heartbeat, for a part that is not one of the supervisor's components.
  std::optional<Time> heard{};
  Duration silent{};
  std::uint32_t restarts{};
  std::uint32_t hung{};  ///< Number of threads that it left behind.
  std::string text{};
};

}  // namespace adit::agent
