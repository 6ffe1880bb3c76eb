#pragma once
#include <cstdint>
#include <string>

#include "core/result/result.hpp"

namespace adit::sim {

/// `--seeds A..B`, both included.
struct SeedRange {
  std::uint64_t first{1}, last{1};
};

/// Reason::bad_argument tells what to type.
Result<SeedRange> parse_seeds(const std::string& text);

}  // namespace adit::sim
