// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string_view>

namespace adit {

/// State of a supervised component.
enum class PartState : std::uint8_t {
  starting,  ///< Ordered; its loop has not reported yet.
  up,
  waiting,  ///< Failed; restarts after the backoff delay.
  failed,   ///< Failed; waits for the operator.
  hung      ///< Does not return; waits for the operator.
};
inline constexpr std::string_view kPartStates[]{"starting", "up", "waiting", "failed", "hung"};
constexpr std::string_view name(PartState state) { return kPartStates[static_cast<std::size_t>(state)]; }

}  // namespace adit
