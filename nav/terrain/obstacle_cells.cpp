// SPDX-License-Identifier: Apache-2.0
#include "nav/terrain/obstacle_cells.hpp"

#include <algorithm>
#include <cmath>

namespace adit::nav {
namespace {

constexpr float kHiddenMemory = 4.0f;  ///< Lifetime of a hidden obstacle, s.
constexpr int kFreeHits = 3;           ///< Consecutive scans that saw through a cell before it is free.
/// Within this distance of the lidar obstacles stay until rays pass through them, m.
constexpr double kBlindRange = 0.6;
constexpr int kMany = 8;       ///< A surface has this many times as many hits as the noise before it.
constexpr int kMeanOver = 32;  ///< Window of the mean, returns: older ones fade, because odometry drifts.
constexpr double kForgetBeyond = 0.3;  ///< Distance beyond the range at which cells are removed, m.
constexpr float kNoise = 0.07f;        ///< Upward bias of the highest of many returns, m.
constexpr float kInside = 0.05f;       ///< Depth inside the footprint, m.

}  // namespace

ObstacleCells::ObstacleCells(const Footprint& body, double range) : body_(body), range_(range), bits_(8) {
  const double reach = (range + kForgetBeyond) / double{kCell};
  while ((1 << bits_) < 2 * reach) ++bits_;
  mask_ = (1 << bits_) - 1;
  max_cells_ = std::min(kMaxCells, static_cast<std::size_t>(4 * reach * reach));
  slots_.assign(std::size_t{1} << (2 * bits_), 0);
  entries_.reserve(max_cells_);
}

void ObstacleCells::clear() {
  entries_.clear();
  std::fill(slots_.begin(), slots_.end(), std::uint32_t{0});
}

void ObstacleCells::mark(float x, float y, float z, float climb) {
  const int ix = cell(x), iy = cell(y);
  const Entry fresh{ix, iy, z, z, scan_, 1, 0, false, false, now_, now_, x, y, 1, 0, climb};
  std::uint32_t& index = slots_[slot(ix, iy)];
  if (index != 0) {
    Entry& e = entries_[index - 1u];
    if (e.ix == ix && e.iy == iy) {
      e.z_low = std::min(e.z_low, z);
      e.z_high = std::max(e.z_high, z);
      e.hits = e.scan == scan_ ? e.hits + 1 : 1;
      e.climb = e.scan == scan_ ? std::max(e.climb, climb) : climb;
      if (e.scan != scan_) e.under = 0;
      e.scan = scan_;
      e.again = true;
      e.weight = std::min(e.weight + 1, kMeanOver);
      e.mean_x += (x - e.mean_x) / static_cast<float>(e.weight);
      e.mean_y += (y - e.mean_y) / static_cast<float>(e.weight);
      return;
    }
    // Left behind on the other side of the torus: its slot is reused.
    e = fresh;
    return;
  }
  if (entries_.size() >= max_cells_) return;
  entries_.push_back(fresh);
  index = static_cast<std::uint32_t>(entries_.size());
}

void ObstacleCells::mark_under(float x, float y) {
  const int ix = cell(x), iy = cell(y);
  const std::uint32_t index = slots_[slot(ix, iy)];
  if (index == 0) return;
  Entry& e = entries_[index - 1u];
  if (e.ix == ix && e.iy == iy && e.scan == scan_) ++e.under;
}

void ObstacleCells::keep(const View& view, const LidarRangeImage& rays, std::span<const Seen> more,
                         const GroundGrid& ground, float step) {
  std::size_t remaining = 0;
  for (Entry& entry : entries_) {
    const bool passable = entry.scan != scan_ && ground.measured(entry.x(), entry.y()) &&
                          entry.z_high - ground.before(entry.x(), entry.y()) <= step;
    if (!stays(entry, view, rays, more, step, passable)) {
      slots_[slot(entry.ix, entry.iy)] = 0;
      continue;
    }
    entries_[remaining] = entry;
    slots_[slot(entry.ix, entry.iy)] = static_cast<std::uint32_t>(++remaining);
  }
  entries_.resize(remaining);
}

bool ObstacleCells::stray(const Entry& entry, float dx, float dy, float range) const {
  if (entry.hits >= kMany || range < 0.05f) return false;
  for (int further = 1; further <= 2; ++further) {
    const float along = static_cast<float>(further) / range;
    const int ix = entry.ix + round_down(along * dx + 0.5f), iy = entry.iy + round_down(along * dy + 0.5f);
    const std::uint32_t index = slots_[slot(ix, iy)];
    if (index == 0) continue;
    const Entry& behind = entries_[index - 1u];
    if (behind.ix == ix && behind.iy == iy && behind.scan == scan_ && behind.hits >= kMany * entry.hits)
      return true;
  }
  return false;
}

bool ObstacleCells::stays(Entry& entry, const View& view, const LidarRangeImage& rays,
                          std::span<const Seen> more, float step, bool passable) const {
  const float dx = entry.x() - view.sensor.x(), dy = entry.y() - view.sensor.y();
  const float range = std::sqrt(dx * dx + dy * dy);
  if (entry.scan == scan_) {
    if (entry.under > entry.hits && entry.climb <= step + kNoise) return false;
    entry.free_hits = 0;
    if (stray(entry, dx, dy, range)) return entry.solid && now_ - entry.stamp <= kHiddenMemory;
    entry.solid = true;
    entry.stamp = now_;
    return true;
  }
  if (range > range_ + kForgetBeyond + view.lidar.head<2>().norm()) return false;
  const Eigen::Vector3f low = view.seen(entry.x(), entry.y(), entry.z_low);
  const Eigen::Vector3f high = low + view.up(entry.z_high - entry.z_low);
  // The robot itself is here, so there is no obstacle.
  if (body_.depth(low.x() + view.lidar.x(), low.y() + view.lidar.y()) >= kInside) return false;
  if (passable && ++entry.free_hits >= kFreeHits) return false;
  const bool through = std::any_of(more.begin(), more.end(), [&](const Seen& seen) {
    const Eigen::Vector3f foot = seen.view.seen(entry.x(), entry.y(), entry.z_low);
    return seen.rays.saw_through(foot, foot + seen.view.up(entry.z_high - entry.z_low), 3.0f * kCell);
  });
  if (!through && (range < 0.05f || high.z() < (rays.lowest() - 0.01f) * range)) {
    entry.stamp = now_;  // In the blind spot, where no ray can show that it is free.
    return true;
  }
  if (through || rays.saw_through(low, high, 3.0f * kCell)) {
    if (++entry.free_hits >= kFreeHits) return false;
  } else if (!passable) {
    entry.free_hits = 0;
  }
  // Closer than the lidar's minimum range an obstacle is not seen any more, and stays.
  return range < kBlindRange || now_ - entry.stamp <= kHiddenMemory;
}

}  // namespace adit::nav
