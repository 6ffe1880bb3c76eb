// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <vector>

namespace adit::sim {

using Indices = std::vector<std::size_t>;
/// Whether these alone, ascending, still fail.
using Fails = std::function<bool(const Indices& remaining)>;

/// The fewest of `count` things that fail, as far as taking away parts of them finds out: none of those left
/// can be spared alone. All of them together must fail. Delta debugging, ddmin (Zeller and Hildebrandt,
/// 2002); nothing at all is tried first. `fails` is not asked twice about the same.
Indices ddmin(std::size_t count, const Fails& fails);

/// Tries every choice of fewer than `limit` of `count` things, the smallest first, of at most `max_size`
/// things and with at most `tries` calls of `fails`. Returns the first that fails, or nothing.
std::vector<Indices> fewer(std::size_t count, std::size_t limit, std::size_t max_size, std::size_t tries,
                           const Fails& fails);

}  // namespace adit::sim
