// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <compare>
#include <cstdint>
#include <string>

namespace adit::perception {

/// Names a submap on the air, on disk and in the station.
struct SubmapKey {
  std::string robot{};    ///< 1 to 32 characters.
  std::uint64_t start{};  ///< Random id of the map that the robot began; a new map has a new id.
  std::uint32_t index{};  ///< Number within that map, from 0.

  auto operator<=>(const SubmapKey&) const = default;
};

}  // namespace adit::perception
