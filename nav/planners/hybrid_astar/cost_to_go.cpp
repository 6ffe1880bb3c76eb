// SPDX-License-Identifier: Apache-2.0
#include "nav/planners/hybrid_astar/cost_to_go.hpp"

#include <algorithm>
#include <cmath>

namespace adit::nav {
namespace {

/// A target inside an obstacle is approached to within this distance, m.
constexpr float kNearTarget = 1.2f;
constexpr float kMissed = 3.0f;  ///< Cost of each metre that remains to such a target.
/// Clearance beyond the body's need, m: nearer to obstacles a path has a higher cost.
constexpr float kComfort = 0.3f;
constexpr float kCrowded = 1.5f;  ///< Additional cost per metre at the least clearance.
constexpr std::size_t kMaxOpen = 8 * CostToGo::kSide * CostToGo::kSide + 8;

}  // namespace

CostToGo::CostToGo() : cost_(kSide * kSide, kUnreachable), free_(kSide * kSide, 0) {
  open_.reserve(kMaxOpen);
}

void CostToGo::offer(int cell, float cost) {
  const auto at = static_cast<std::size_t>(cell);
  if (free_[at] == 0 || cost >= cost_[at] || open_.size() == kMaxOpen) return;
  cost_[at] = cost;
  open_.push_back({cost, cell});
  std::push_heap(open_.begin(), open_.end());
}

void CostToGo::fill(const DistanceField& field, const Eigen::Vector2d& target, float radius) {
  const auto tx = static_cast<float>(target.x()), ty = static_cast<float>(target.y());
  std::fill(cost_.begin(), cost_.end(), kUnreachable);
  open_.clear();
  // Cells are coarse: a passage whose middle lies between two of them counts too.
  const float needs = std::max(0.05f, radius - kCell / 2);
  const auto room = [&](int i, int j) { return field.clearance(middle(i), middle(j)) - needs; };
  for (int j = 0; j < kSide; ++j)
    for (int i = 0; i < kSide; ++i) free_[j * kSide + i] = room(i, j) >= 0.0f;
  const bool beside = std::fabs(tx) > kHalf - kCell || std::fabs(ty) > kHalf - kCell;
  const bool is_inside = !beside && field.clearance(tx, ty) < radius;
  const float from = std::hypot(tx, ty);
  least_ = is_inside ? kUnreachable : 0.0f;
  for (int j = 0; j < kSide; ++j)
    for (int i = 0; i < kSide; ++i) {
      const float away = std::hypot(middle(i) - tx, middle(j) - ty);
      if (beside && away < from && (i == 0 || j == 0 || i == kSide - 1 || j == kSide - 1))
        offer(j * kSide + i, away);
      if (!beside && away < kCell) offer(j * kSide + i, away);
      if (!is_inside || away >= kNearTarget) continue;
      offer(j * kSide + i, kMissed * away);
      if (room(i, j) >= kCell / 2) least_ = std::min(least_, kMissed * away);
    }
  while (!open_.empty()) {
    std::pop_heap(open_.begin(), open_.end());
    const Open next = open_.back();
    open_.pop_back();
    if (next.cost > cost_[next.cell]) continue;
    const int i = next.cell % kSide, j = next.cell / kSide;
    for (int b = std::max(0, j - 1); b <= std::min(kSide - 1, j + 1); ++b)
      for (int a = std::max(0, i - 1); a <= std::min(kSide - 1, i + 1); ++a) {
        if (a == i && b == j) continue;
        const float crowd = 1.0f + kCrowded * (1.0f - std::clamp(room(a, b) / kComfort, 0.0f, 1.0f));
        const float way = kCell * (a != i && b != j ? 1.41421356f : 1.0f) * crowd;
        offer(b * kSide + a, next.cost + way);
      }
  }
}

float CostToGo::at(float x, float y) const {
  const int i = static_cast<int>((x + kHalf) / kCell), j = static_cast<int>((y + kHalf) / kCell);
  if (x < -kHalf || y < -kHalf || i >= kSide || j >= kSide) return kUnreachable;
  // The best of the cells around, so that a body close to an obstacle has a value too.
  float best = kUnreachable;
  for (int b = std::max(0, j - 1); b <= std::min(kSide - 1, j + 1); ++b)
    for (int a = std::max(0, i - 1); a <= std::min(kSide - 1, i + 1); ++a) {
      const float cost = cost_[b * kSide + a];
      if (cost < kUnreachable) best = std::min(best, cost + std::hypot(middle(a) - x, middle(b) - y));
    }
  return best;
}

}  // namespace adit::nav
