// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <set>
#include <string>

#include "core/result/result.hpp"

namespace adit::bench {

struct RowOptions {
  std::set<std::string> rows{};  ///< 17 to 20 of the specification.
  bool alone{};                  ///< Without the other rules.
  bool quick{false};             ///< One world and two minutes.
  std::uint64_t seed{1};
};

/// Prints the rows on what a mission sends. Returns the number of voxels that the station showed otherwise
/// than the robots by this project's rule.
Result<std::size_t> print_mission_rows(const RowOptions& options);
/// Prints what a closure that moves 100 submaps sends, for one link.
Result<void> print_closure(const std::string& link, std::uint64_t seed);

/// Bytes that a map takes, by voxel size; `mission`: also what a whole drive of `length` m sends to a station
/// that hears everything.
Result<void> print_coding(double length, bool mission);

}  // namespace adit::bench
