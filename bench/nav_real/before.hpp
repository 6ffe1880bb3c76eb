// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <string_view>
#include <utility>

namespace adit::bench {

inline constexpr const char* kBeforeCommit = "beaa3bf";

/// What a row of the table showed before navigation was changed for real buildings, from small samples
/// (docs/measurements.md); "" for others.
inline std::string_view before(std::string_view row) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 6> kRows{{
      {"goals tracked", "2 of 2 reached, 1.18 x"},
      {"doors", "6 of 6 passed (6 pairs)"},
      {"straight tracked (6, 0) to (14, 0)", "0 of 3 within 60 s"},
      {"impossible goals", "2 of 2 refused at once, 1 of 4 others within the budget, up to 40 m"},
      {"tilt", "1.0e-2, at 10 degrees down; tilt bias: 0"},
      {"street singly", "drops 6.2e-3, worst scan 3e-2, unknown 99 %"},
  }};
  for (const auto& [name, figure] : kRows)
    if (name == row) return figure;
  return "";
}

}  // namespace adit::bench
