// SPDX-License-Identifier: Apache-2.0
#include "nav/tracking/upright_range_image.hpp"

#include <algorithm>

namespace adit::nav {

void UprightRangeImage::spread() {
  constexpr int kAround = 2;  // Half width of the neighbourhood, bins.
  std::array<std::uint16_t, kColumns + 2 * kAround> row{};
  for (int r = 0; r < kRows; ++r) {
    std::uint16_t* bins = bins_.data() + static_cast<std::ptrdiff_t>(r) * kColumns;
    std::copy_n(bins, kColumns, row.begin() + kAround);
    std::copy_n(bins + kColumns - kAround, kAround, row.begin());
    std::copy_n(bins, kAround, row.end() - kAround);
    for (int c = 0; c < kColumns; ++c) bins[c] = *std::min_element(&row[c], &row[c] + 2 * kAround + 1);
  }
  // The unmodified rows above, oldest first.
  std::array<std::array<std::uint16_t, kColumns>, kAround> above{};
  for (auto& r : above) r.fill(kNothing);
  for (int r = 0; r < kRows; ++r) {
    std::uint16_t* bins = bins_.data() + static_cast<std::ptrdiff_t>(r) * kColumns;
    for (int c = 0; c < kColumns; ++c) {
      const std::uint16_t own = bins[c];
      std::uint16_t least = std::min({own, above[0][c], above[1][c]});
      for (int next = 1; next <= kAround && r + next < kRows; ++next)
        least = std::min(least, bins[next * kColumns + c]);
      above[0][c] = above[1][c];
      above[1][c] = own;
      bins[c] = least;
    }
  }
}

}  // namespace adit::nav
