// SPDX-License-Identifier: Apache-2.0
#include "perception/input/isolated_returns.hpp"

#include <algorithm>
#include <cmath>

namespace adit::perception {
namespace {

constexpr float kSlack = 0.1f, kSlackShare = 0.01f;  ///< Of a neighbour's range, m and share of it.
constexpr std::uint32_t kAside = 2;                  ///< Columns to each side.
constexpr std::uint32_t kLeastColumns = 16, kMostColumns = 4096;
constexpr std::size_t kFewReturns = 200;  ///< Of fewer nothing is concluded.
constexpr double kLeastOfRing = 50;       ///< Returns of a ring that show its elevation.
constexpr std::uint32_t kNoCell = ~std::uint32_t{0};

/// Grows with the azimuth from 0 to 4, without a trigonometric function.
float quarter_turns(float x, float y) {
  const float part = y / (std::abs(x) + std::abs(y));
  return x >= 0 ? (y >= 0 ? part : 4 + part) : 2 - part;
}

}  // namespace

std::optional<bool> IsolatedReturns::are_cones(const Sweep& sweep, std::uint32_t rings) {
  struct Ring {
    double count{}, sum{}, squares{};
    double mean() const { return sum / count; }
    double variance() const { return std::max(0.0, squares / count - mean() * mean()); }
  };
  std::vector<Ring> all(rings);
  for (const TimedPoint& point : sweep.points) {
    const float range = point.position.norm();
    if (!(range > 0.1f && range < 1e6f)) continue;
    const double rise = double{point.position.z()} / range;
    Ring& ring = all[point.ring];
    ring.count += 1;
    ring.sum += rise;
    ring.squares += rise * rise;
  }
  std::erase_if(all, [](const Ring& ring) { return ring.count < kLeastOfRing; });
  if (all.size() < 2) return std::nullopt;
  std::sort(all.begin(), all.end(), [](const Ring& a, const Ring& b) { return a.mean() < b.mean(); });
  double spread = 0;
  for (const Ring& ring : all) spread += std::sqrt(ring.variance());
  const double spacing = (all.back().mean() - all.front().mean()) / static_cast<double>(all.size() - 1);
  return spread / static_cast<double>(all.size()) < spacing;
}

const std::vector<std::uint8_t>& IsolatedReturns::find(const Sweep& sweep) {
  isolated_.clear();
  scattered_ = false;
  std::uint32_t rings = 0;
  for (const TimedPoint& p : sweep.points) rings = std::max<std::uint32_t>(rings, p.ring + 1u);
  if (rings < 2 || rings > kMaxRings) return isolated_;
  if (!cones_) cones_ = are_cones(sweep, rings);
  if (!cones_.value_or(true)) return isolated_;
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
  std::size_t returns = 0, alone = 0;
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
    ++returns;
    alone += !found;
  }
  scattered_ = returns >= kFewReturns && static_cast<double>(alone) > kMost * static_cast<double>(returns);
  if (scattered_) isolated_.clear();
  return isolated_;
}

}  // namespace adit::perception
