// SPDX-License-Identifier: Apache-2.0
#include "perception/input/isolated_returns.hpp"

#include <algorithm>
#include <cmath>

namespace adit::perception {
namespace {

constexpr float kSlack = 0.1f, kSlackShare = 0.01f;  ///< Of a neighbour's range, m and share of it.
constexpr std::uint32_t kAside = 2;                  ///< Columns to each side.
constexpr std::uint32_t kLeastColumns = 16, kMostColumns = 4096;
constexpr std::uint32_t kNoCell = ~std::uint32_t{0};

/// Grows with the azimuth from 0 to 4, without a trigonometric function.
float quarter_turns(float x, float y) {
  const float part = y / (std::abs(x) + std::abs(y));
  return x >= 0 ? (y >= 0 ? part : 4 + part) : 2 - part;
}

}  // namespace

const std::vector<std::uint8_t>& IsolatedReturns::find(const Sweep& sweep) {
  isolated_.clear();
  std::uint32_t rings = 0;
  for (const TimedPoint& p : sweep.points) rings = std::max<std::uint32_t>(rings, p.ring + 1u);
  if (rings < 2 || rings > kMaxRings) return isolated_;
  const auto columns =
      std::clamp(static_cast<std::uint32_t>(sweep.points.size()) / rings, kLeastColumns, kMostColumns);
  // Two columns more on each side repeat those of the other end; a ring more above and below is empty.
  const std::uint32_t width = columns + 2 * kAside;
  ranges_.assign(std::size_t{width} * (rings + 2), 0.0f);
  cells_.assign(sweep.points.size(), kNoCell);
  isolated_.assign(sweep.points.size(), 0);
  const float scale = static_cast<float>(columns) / 4;
  for (std::size_t n = 0; n < sweep.points.size(); ++n) {
    const Eigen::Vector3f& p = sweep.points[n].position;
    const float range = p.norm();
    if (!(range > 0.0f && range < 1e6f) || (p.x() == 0.0f && p.y() == 0.0f)) continue;
    const auto column =
        std::min(static_cast<std::uint32_t>(quarter_turns(p.x(), p.y()) * scale), columns - 1);
    const std::uint32_t row = (sweep.points[n].ring + 1u) * width;
    cells_[n] = row + kAside + column;
    ranges_[cells_[n]] = range;
    if (column < kAside) ranges_[row + kAside + columns + column] = range;
    if (column >= columns - kAside) ranges_[row + column + kAside - columns] = range;
  }
  for (std::size_t n = 0; n < sweep.points.size(); ++n) {
    if (cells_[n] == kNoCell) continue;
    const float range = sweep.points[n].position.norm(), slack = kSlack + kSlackShare * range;
    const float* at = &ranges_[cells_[n]];
    const auto near = [&](std::ptrdiff_t shift) { return std::abs(at[shift] - range) <= slack; };
    const auto up = static_cast<std::ptrdiff_t>(width);
    bool found = near(-1) || near(1) || near(-2) || near(2);
    for (std::ptrdiff_t aside = -2; aside <= 2 && !found; ++aside)
      found = near(aside - up) || near(aside + up);
    isolated_[n] = !found;
  }
  return isolated_;
}

}  // namespace adit::perception
