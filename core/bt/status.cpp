// SPDX-License-Identifier: Apache-2.0
#include "core/bt/status.hpp"

#include <array>

namespace adit::bt {

namespace {
constexpr std::array<std::string_view, 5> kNames{"IDLE", "RUNNING", "SUCCESS", "FAILURE", "SKIPPED"};
}

std::string_view name(NodeStatus status) {
  const auto index = static_cast<std::size_t>(status);
  return index < kNames.size() ? kNames[index] : "UNDEFINED";
}

std::optional<NodeStatus> status_from_name(std::string_view text) {
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    if (kNames[i] == text) return static_cast<NodeStatus>(i);
  }
  return std::nullopt;
}

}  // namespace adit::bt
