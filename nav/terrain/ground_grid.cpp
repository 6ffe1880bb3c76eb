// SPDX-License-Identifier: Apache-2.0
#include "nav/terrain/ground_grid.hpp"

#include <cmath>
#include <cstdlib>

namespace adit::nav {
namespace {

constexpr float kLongAgo = -1e9f;
constexpr float kFlat = 0.02f;       ///< m: unevenness that is no slope
constexpr int kBlindCells = 5;       ///< over more cells nobody knows how the ground goes on
constexpr int kFallCells = 3;        ///< the same where it falls: rays pass over what is lower
constexpr float kNewest = 0.5f;      ///< weight of a scan in a cell's height
constexpr float kSame = 0.05f;       ///< m: what differs more is another thing
constexpr std::size_t kEnough = 40;  ///< cells that tell how scan and map lie to each other
constexpr float kRecent = 5.0f;      ///< s: and are younger than this
constexpr float kUnsure = 0.003f;    ///< m: such a disagreement is noise
constexpr float kMostLift = 0.25f;   ///< m a scan

/// The gap of a cell beside one of this gap.
constexpr std::uint8_t after(std::uint8_t gap) {
  return gap == GroundGrid::kNever ? gap : static_cast<std::uint8_t>(gap + 1);
}

}  // namespace

GroundGrid::GroundGrid(const GroundParams& params)
    : params_(params),
      low_(kTorus * kTorus, kNothing),
      height_(kTorus * kTorus, 0.0f),
      stamp_(kTorus * kTorus, kLongAgo),
      is_ground_(kTorus * kTorus, 0),
      ground_(kSide * kSide, 0.0f),
      floor_(kSide * kSide, 0.0f),
      gap_(kSide * kSide, kNever),
      fresh_(kSide * kSide, 0) {
  steps_.reserve(kSide * kSide);
  differences_.reserve(kSide * kSide);
  entered_.reserve(kTorus * kTorus);
  for (int dx = -kHalf; dx <= kHalf; ++dx)
    for (int dy = -kHalf; dy <= kHalf; ++dy) {
      if (dx == 0 && dy == 0) continue;
      // One step towards the middle along the longer axis, and diagonally where there is a diagonal.
      const int sx = (dx > 0) - (dx < 0), sy = (dy > 0) - (dy < 0);
      const bool along_x = std::abs(dx) >= std::abs(dy), diagonal = std::abs(dx) == std::abs(dy);
      // On the diagonal both neighbours would be the same outer one: the diagonal step alone counts. On the
      // axes there is no diagonal: the cell beside counts, so that no way hangs on single cells.
      int ax = along_x ? dx - sx : dx, ay = along_x ? dy : dy - sy;
      int bx = dx - sx, by = dy - sy;
      if (diagonal) ax = bx, ay = by;
      if (dy == 0 && std::abs(dx) > 1) by = 1;
      if (dx == 0 && std::abs(dy) > 1) bx = 1;
      const auto index = [](int i, int j) {
        return static_cast<std::uint16_t>((i + kHalf) * kSide + j + kHalf);
      };
      const auto byte = [](int v) { return static_cast<std::int8_t>(v); };
      steps_.push_back({index(dx, dy), index(ax, ay), index(bx, by), byte(dx), byte(dy), byte(dx - ax),
                        byte(dy - ay), byte(dx - bx), byte(dy - by)});
    }
  const auto ring = [](const Step& s) { return std::max(std::abs(s.dx), std::abs(s.dy)); };
  const auto off_axis = [](const Step& s) { return std::min(std::abs(s.dx), std::abs(s.dy)); };
  std::stable_sort(steps_.begin(), steps_.end(), [&](const Step& a, const Step& b) {
    return ring(a) != ring(b) ? ring(a) < ring(b) : off_axis(a) < off_axis(b);
  });
  for (std::size_t gap = 0; gap < rise_.size(); ++gap) {
    // Under the robot and around it, where nothing was seen yet, the ground lies as the body does.
    const int cells = gap >= kNever ? 0 : static_cast<int>(gap);
    const auto by_slope = [&](int most) {
      return params_.slope * kCell * static_cast<float>(std::min(cells, most));
    };
    rise_[gap] = std::min(std::max(params_.rise, kFlat + by_slope(kBlindCells)), params_.most);
    fall_[gap] = std::min(std::max(params_.rise, kFlat + by_slope(kFallCells)), params_.drop);
    climb_[gap] = std::max(by_slope(kBlindCells), params_.slope * kCell);
  }
}

void GroundGrid::clear() {
  std::fill(stamp_.begin(), stamp_.end(), kLongAgo);
  placed_ = false;
}

void GroundGrid::roll(int x, int y) {
  entered_.clear();
  const int old_x = centre_x_, old_y = centre_y_;
  centre_x_ = x;
  centre_y_ = y;
  if (placed_ && x == old_x && y == old_y) return;
  const bool all = !placed_ || std::abs(x - old_x) > kSide || std::abs(y - old_y) > kSide;
  placed_ = true;
  // Calls `each` for the cells of a square around the robot that were not in it before.
  const auto entering = [&](int half, const auto& each) {
    for (int i = x - half; i <= x + half; ++i) {
      const bool new_row = all || std::abs(i - old_x) > half;
      if (!new_row && y == old_y) continue;
      for (int j = y - half; j <= y + half; ++j)
        if (new_row || std::abs(j - old_y) > half) each(slot(i, j));
    }
  };
  // Who turns round on a landing has to know the stairs that he came up, which cannot be seen from there.
  entering(kKept, [&](std::size_t s) { stamp_[s] = kLongAgo; });
  entering(kHalf, [&](std::size_t s) { entered_.push_back(s); });
}

void GroundGrid::begin_scan(float x, float y, float now) {
  now_ = now;
  roll(cell(x), cell(y));
  std::fill(low_.begin(), low_.end(), kNothing);
}

float GroundGrid::disagreement() {
  differences_.clear();
  for (int i = -kHalf; i <= kHalf; ++i)
    for (int j = -kHalf; j <= kHalf; ++j) {
      const std::size_t s = slot(centre_x_ + i, centre_y_ + j);
      if (low_[s] < kNothing && is_ground_[s] && now_ - stamp_[s] <= kRecent)
        differences_.push_back(height_[s] - low_[s]);
    }
  if (differences_.size() < kEnough) return 0.0f;
  const auto middle = differences_.begin() + static_cast<std::ptrdiff_t>(differences_.size() / 2);
  std::nth_element(differences_.begin(), middle, differences_.end());
  const float sure = std::max(0.0f, std::fabs(*middle) - kUnsure);
  return std::copysign(std::min(sure, kMostLift), *middle);
}

void GroundGrid::grow(float lift, float z, const Eigen::Vector2f& tilt) {
  const float steep = tilt.norm() / params_.slope;
  const Eigen::Vector2f lean = kCell / std::max(1.0f, steep) * tilt;
  constexpr int kMiddle = kHalf * kSide + kHalf;
  ground_[kMiddle] = z;
  floor_[kMiddle] = z;
  gap_[kMiddle] = kNever;
  for (const Step& s : steps_) {
    const std::size_t at = slot(centre_x_ + s.dx, centre_y_ + s.dy);
    const bool seen = low_[at] < kNothing;
    if (seen) {
      const float low = low_[at] + lift;
      const bool same = now_ - stamp_[at] <= params_.memory && std::fabs(low - height_[at]) < kSame;
      height_[at] = same ? height_[at] + kNewest * (low - height_[at]) : low;
      stamp_[at] = now_;
    }
    const float a = ground_[s.inner_a] + lean.x() * static_cast<float>(s.from_a_x) +
                    lean.y() * static_cast<float>(s.from_a_y);
    const float b = ground_[s.inner_b] + lean.x() * static_cast<float>(s.from_b_x) +
                    lean.y() * static_cast<float>(s.from_b_y);
    // It is ground when it follows from either neighbour; from the one it fits better.
    const bool by_a = std::fabs(height_[at] - a) <= std::fabs(height_[at] - b);
    const std::uint8_t gap = after(gap_[by_a ? s.inner_a : s.inner_b]);
    const float rise = height_[at] - (by_a ? a : b);
    const bool ground = now_ - stamp_[at] <= params_.memory && rise <= rise_[gap] && rise >= -fall_[gap];
    ground_[s.index] = ground ? height_[at] : 0.5f * (a + b);
    floor_[s.index] =
        std::min(ground_[s.index], (ground ? height_[at] - rise : std::min(a, b)) + climb_[gap]);
    gap_[s.index] = ground ? std::uint8_t{0} : after(std::min(gap_[s.inner_a], gap_[s.inner_b]));
    fresh_[s.index] = ground && seen;
    is_ground_[at] = ground;
  }
}

}  // namespace adit::nav
