// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <string>
#include <vector>

#include "bench/map_link/samples.hpp"

namespace adit::bench {

/// Grows a tree of contexts for each decision: of all leaves of all trees, the one is split next whose best
/// question saves most bits, until the text of the trees has `max_characters` or a question saves fewer than
/// `min_gain` bits. Returns the text.
std::string grow_trees(const std::array<std::vector<Sample>, perception::kDecisions>& samples,
                       std::size_t max_characters, double min_gain);

}  // namespace adit::bench
