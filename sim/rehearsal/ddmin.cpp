// SPDX-License-Identifier: Apache-2.0
#include "sim/rehearsal/ddmin.hpp"

#include <algorithm>
#include <map>
#include <numeric>

namespace adit::sim {
namespace {

// Everything but the chunk from `begin` to `end`.
Indices without(const Indices& all, std::size_t begin, std::size_t end) {
  Indices out(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(begin));
  out.insert(out.end(), all.begin() + static_cast<std::ptrdiff_t>(end), all.end());
  return out;
}

}  // namespace

Indices ddmin(std::size_t count, const Fails& fails) {
  std::map<Indices, bool> asked;
  const auto ask = [&](const Indices& remaining) {
    const auto [it, fresh] = asked.try_emplace(remaining, false);
    if (fresh) it->second = fails(remaining);
    return it->second;
  };
  Indices remaining(count);
  std::iota(remaining.begin(), remaining.end(), std::size_t{0});
  if (count > 0 && ask({})) return {};
  std::size_t parts = 2;
  while (remaining.size() >= 2) {
    const std::size_t size = remaining.size();
    parts = std::min(parts, size);
    bool smaller = false;
    // A part alone, then all but a part.
    for (int complement = parts == 2 ? 1 : 0; complement < 2 && !smaller; ++complement)
      for (std::size_t part = 0; part < parts && !smaller; ++part) {
        const std::size_t begin = part * size / parts, end = (part + 1) * size / parts;
        const Indices rest = without(remaining, begin, end);
        const Indices tried = complement ? rest
                                         : Indices(remaining.begin() + static_cast<std::ptrdiff_t>(begin),
                                                   remaining.begin() + static_cast<std::ptrdiff_t>(end));
        if (tried.empty() || !ask(tried)) continue;
        remaining = tried;
        parts = complement ? std::max<std::size_t>(2, parts - 1) : 2;
        smaller = true;
      }
    if (smaller) continue;
    if (parts >= size) break;
    parts *= 2;
  }
  return remaining;
}

std::vector<Indices> fewer(std::size_t count, std::size_t limit, std::size_t max_size, std::size_t tries,
                           const Fails& fails) {
  for (std::size_t size = 0; size <= std::min(max_size, count) && size < limit; ++size) {
    std::vector<bool> chosen(count, false);
    std::fill(chosen.begin(), chosen.begin() + static_cast<std::ptrdiff_t>(size), true);
    do {
      if (tries-- == 0) return {};
      Indices tried;
      for (std::size_t i = 0; i < count; ++i)
        if (chosen[i]) tried.push_back(i);
      if (fails(tried)) return {tried};
    } while (std::prev_permutation(chosen.begin(), chosen.end()));
  }
  return {};
}

}  // namespace adit::sim
