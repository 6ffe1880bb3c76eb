// SPDX-License-Identifier: Apache-2.0
#include "nav/planners/hybrid_astar/distance_field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace adit::nav {

void DistanceField::fill(std::span<const ObstaclePoint> obstacles, float ahead) {
  std::fill(distance_.begin(), distance_.end(), kNone);
  std::fill(cost_.begin(), cost_.end(), 0.0f);
  for (const ObstaclePoint& o : obstacles) {
    const float x = o.x + ahead;
    if (!(std::fabs(x) < kHalf && std::fabs(o.y) < kHalf)) continue;
    const std::size_t at = index(std::min(cell(x), kSide - 1), std::min(cell(o.y), kSide - 1));
    if (o.cost >= 1.0f)
      distance_[at] = 0.0f;
    else
      cost_[at] = std::max(cost_[at], o.cost);
  }
  points_.fill(obstacles, ahead);
  for (int i = 0; i < kSide; ++i) transform(index(i, 0), kSide);
  for (int j = 0; j < kSide; ++j) transform(index(0, j), 1);
  for (float& d : distance_) d = std::min(kFar, kCell * std::sqrt(d));
}

void DistanceField::transform(std::size_t first, std::size_t stride) {
  // Computes the lower envelope of parabolas, one over each cell.
  bool any = false;
  for (std::size_t n = 0; n < kSide; ++n) {
    row_[n] = distance_[first + n * stride];
    any |= row_[n] < kNone;
  }
  if (!any) return;
  const auto meet = [this](int p, int q) {
    const auto a = static_cast<float>(p), b = static_cast<float>(q);
    return ((row_[p] + a * a) - (row_[q] + b * b)) / (2 * (a - b));
  };
  constexpr float kEnd = std::numeric_limits<float>::infinity();
  int last = 0;
  parabola_[0] = 0;
  border_[0] = -kEnd;
  border_[1] = kEnd;
  for (int q = 1; q < kSide; ++q) {
    float s = meet(q, parabola_[last]);
    while (s <= border_[last]) s = meet(q, parabola_[--last]);
    parabola_[++last] = q;
    border_[last] = s;
    border_[last + 1] = kEnd;
  }
  int k = 0;
  for (int q = 0; q < kSide; ++q) {
    while (border_[k + 1] < static_cast<float>(q)) ++k;
    const auto off = static_cast<float>(q - parabola_[k]);
    out_[q] = off * off + row_[parabola_[k]];
  }
  for (std::size_t n = 0; n < kSide; ++n) distance_[first + n * stride] = out_[n];
}

}  // namespace adit::nav
