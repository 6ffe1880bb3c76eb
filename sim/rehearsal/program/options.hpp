// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>

#include "core/result/result.hpp"

namespace adit::sim {

/// `--seeds A..B`, both included.
struct SeedRange {
  std::uint64_t first{1}, last{1};
};

/// The text of Reason::bad_argument says what to type.
Result<SeedRange> parse_seeds(const std::string& text);

}  // namespace adit::sim
