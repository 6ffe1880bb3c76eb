// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

namespace adit::station {

/// Counts of a station's commands since its start; repeats do not count.
struct Counts {
  std::uint64_t sent{}, repeats{}, accepted{}, refused{}, unanswered{};
  bool operator==(const Counts&) const = default;
};

}  // namespace adit::station
