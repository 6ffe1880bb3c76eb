// SPDX-License-Identifier: Apache-2.0
#include "nav/planners/hybrid_astar/solid_points.hpp"

#include <algorithm>
#include <cmath>

namespace adit::nav {

void SolidPoints::fill(std::span<const ObstaclePoint> obstacles, float ahead) {
  const auto square = [ahead](const ObstaclePoint& o) -> int {
    const float x = o.x + ahead;
    if (o.cost < 1.0f || !(std::fabs(x) < kHalf && std::fabs(o.y) < kHalf)) return -1;
    return cell(o.y) * kSide + cell(x);
  };
  // Counting sort by cell.
  begin_.fill(0);
  std::size_t count = 0;
  for (const ObstaclePoint& o : obstacles)
    if (const int at = square(o); at >= 0 && count < kMax) {
      ++begin_[static_cast<std::size_t>(at) + 1];
      ++count;
    }
  for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
  auto next = begin_;
  for (const ObstaclePoint& o : obstacles)
    if (const int at = square(o); at >= 0 && count > 0) {
      points_[next[at]++] = {o.x + ahead, o.y};
      --count;
    }
}

float SolidPoints::depth(const Footprint& body, const Pose2& pose) const {
  constexpr float kNear = 0.2f;
  const IntoPose into(pose);
  const auto reach = static_cast<float>(body.radius()) + kNear;
  float most = -kNear;
  for (int j = cell(into.y - reach); j <= cell(into.y + reach); ++j) {
    // The cells of a row are contiguous.
    const auto row = static_cast<std::size_t>(j * kSide);
    const auto from = row + static_cast<std::size_t>(cell(into.x - reach));
    const auto to = row + static_cast<std::size_t>(cell(into.x + reach));
    for (std::uint32_t i = begin_[from]; i < begin_[to + 1]; ++i)
      most = std::max(most, body.depth(into(points_[i].x, points_[i].y)));
  }
  return most;
}

}  // namespace adit::nav
