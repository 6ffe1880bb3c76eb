// SPDX-License-Identifier: Apache-2.0
#include "nav/terrain/drops.hpp"

#include <algorithm>
#include <cmath>

namespace adit::nav {
namespace {

constexpr float kDropMemory = 20.0f;  ///< Lifetime of a drop that could be seen and is not, s.
/// Consecutive scans without an expected return of the ground before it counts as a hole.
constexpr int kMissingReturns = 3;
/// Evidence of one ray below the ground: one of three may be a reflection, log-odds.
constexpr float kRay = 0.75f;
constexpr float kMissing = 3 * kRay;          ///< Evidence of returns that are missing, log-odds.
constexpr float kBelieved = 2.2f;             ///< The log-odds of Drops::kBlocks.
constexpr float kSlows = 1.7f;                ///< Limit for missing returns without a second cue.
constexpr float kMinReported = 1.4f;          ///< Below this, a single ray, a cell is noise.
constexpr float kMaxOdds = 6.0f;              ///< Upper limit of the log-odds.
constexpr float kMinOdds = -2.2f;             ///< Lower limit, for ground that was measured often.
constexpr float kGround = 0.75f;              ///< Evidence of one measurement of the ground.
constexpr float kNearest = 0.3f;              ///< Nearer cells are not judged, m.
constexpr float kMissingReturnsRange = 2.0f;  ///< Up to this range missing returns alone make a drop, m.
/// Rays at a flatter angle may not return from wet asphalt.
constexpr float kGrazing = 0.125f;
constexpr float kSparse = 0.03f;  ///< Rings farther apart leave rows empty between them, tangent.
/// Minimum number of columns with returns in a ring.
constexpr int kRing = LidarRangeImage::kColumns * 3 / 8;

std::size_t at(int row, int column) {
  return static_cast<std::size_t>(row * LidarRangeImage::kColumns + column);
}

using Columns = std::array<bool, LidarRangeImage::kColumns>;

// Columns in which the ring of a row returns, in that row or in higher ones to which it drifted while the
// body tilted. Only sparse rings are followed, and only upwards: beside a hole, another ring would be taken
// for it.
Columns follow_ring(const LidarRangeImage& rays, int row) {
  constexpr int kGap = 3;  // Columns without a return that a ring may have.
  Columns seen{};
  for (const int direction : {1, -1}) {
    int ring_row = row, gap = kGap + 1;
    for (int n = 0; n < 2 * LidarRangeImage::kColumns; ++n) {
      const int column = direction * n;
      const auto hit = [&](int r) { return r >= row && !rays.empty_at(r, column); };
      int found = hit(row) ? row : -1;
      if (found < 0 && gap <= kGap)
        for (const int r : {ring_row, ring_row - 1, ring_row + 1})
          if (found < 0 && hit(r)) found = r;
      gap = found < 0 ? gap + 1 : 0;
      if (found < 0) continue;
      ring_row = std::min(found, LidarRangeImage::kRows - 2);
      seen[column & (LidarRangeImage::kColumns - 1)] = true;
    }
  }
  return seen;
}

}  // namespace

Drops::Drops(const Geometry& geometry, const GroundGrid& ground)
    : geometry_(geometry),
      edge_cells_(static_cast<int>(std::ceil(geometry.half_body / GroundGrid::kCell)) + 1),
      odds_(ground.places(), 0.0f),
      rays_below_(ground.places(), 0),
      stamp_(ground.places(), 0.0f),
      missing_returns_(LidarRangeImage::kRows * LidarRangeImage::kColumns, 0),
      returned_(LidarRangeImage::kRows * LidarRangeImage::kColumns, 0) {
  cells_.reserve(ground.cells());
}

void Drops::clear() {
  std::fill(odds_.begin(), odds_.end(), 0.0f);
  std::fill(rays_below_.begin(), rays_below_.end(), std::uint8_t{0});
  std::fill(missing_returns_.begin(), missing_returns_.end(), std::uint8_t{0});
  cells_.clear();
}

void Drops::begin_scan(const GroundGrid& ground, std::span<const std::uint8_t> solid, float now,
                       float farthest) {
  solid_ = solid;
  now_ = now;
  farthest_ = farthest;
  for (const std::size_t place : ground.entered()) odds_[place] = 0, rays_below_[place] = 0;
}

bool Drops::has_cue(int index, const GroundGrid& ground) const {
  const int side = ground.side(), i = index / side, j = index % side;
  for (int a = std::max(i - 1, 0); a <= std::min(i + 1, side - 1); ++a)
    for (int b = std::max(j - 1, 0); b <= std::min(j + 1, side - 1); ++b) {
      if (rays_below_[ground.place(a * side + b)] > 0) return true;
    }
  return false;
}

void Drops::vote(int index, float range, Cue cue, const GroundGrid& ground) {
  const std::size_t place = ground.place(index);
  float& odds = odds_[place];
  if (cue == Cue::ray) {
    odds = std::min(odds + kRay, kMaxOdds);
    rays_below_[place] = static_cast<std::uint8_t>(std::min(rays_below_[place] + 1, 255));
  } else if (range <= kMissingReturnsRange || has_cue(index, ground)) {
    odds = std::min(odds + (cue == Cue::missing ? kMissing : kRay), kMaxOdds);
  } else {
    odds = std::max(odds, std::min(odds + kRay, kSlows));
  }
  stamp_[place] = now_;
  any_ = true;
}

bool Drops::under_ground(const View& view, const Eigen::Vector3f& ray, float range, float end,
                         const GroundGrid& ground) const {
  const float length = ray.head<2>().norm();
  const Eigen::Vector3f way = ray / length;
  float under = 0;
  for (float r = range + GroundGrid::kCell; r < end; r += GroundGrid::kCell) {
    const Eigen::Vector3f p = view.sensor + r * way;
    if (!ground.inside(p.x(), p.y())) break;
    const int index = ground.window(p.x(), p.y());
    const bool held = ground.measured(index) || solid_[index] != 0;
    if (held && p.z() < ground.height(index) - geometry_.depth / 2) under += GroundGrid::kCell;
  }
  // One cell may belong to the edge itself.
  return under > 1.5f * GroundGrid::kCell;
}

Drops::Cue Drops::pass(const View& view, const Eigen::Vector3f& ray, float end, Cue cue,
                       const GroundGrid& ground) {
  // Intersects the ray with the ground, assuming that the ground is flat or bends little.
  float t = (ground.at(view.sensor.x() + end * ray.x(), view.sensor.y() + end * ray.y()) - view.sensor.z()) /
            ray.z();
  for (int i = 0; i < 3; ++i)
    t = (ground.at(view.sensor.x() + t * ray.x(), view.sensor.y() + t * ray.y()) - view.sensor.z()) / ray.z();
  const float length = std::sqrt(ray.x() * ray.x() + ray.y() * ray.y());
  const float range = t * length;
  if (!(t < end && range < farthest_ && range > kNearest)) return Cue::none;
  const float ux = ray.x() / length, uy = ray.y() / length;
  const auto index_at = [&](float r) {
    return ground.window(view.sensor.x() + r * ux, view.sensor.y() + r * uy);
  };
  // Distance back to the last measured ground; where rings are far apart that ground must have been measured.
  int back = 0;
  for (; back <= edge_cells_; ++back) {
    const float r = range - static_cast<float>(back) * GroundGrid::kCell;
    if (r < kNearest || (back > 0 && ground.measured(index_at(r)))) break;
  }
  if (back > edge_cells_ && (range > geometry_.sure || cue == Cue::level)) return Cue::none;
  if (cue == Cue::level) cue = Cue::doubtful;
  const bool ray_below = cue == Cue::ray;
  if (ray_below && (range > geometry_.sure || under_ground(view, ray, range, end * length, ground)))
    cue = Cue::doubtful;
  int last = -1;
  for (int n = 0; n < back; ++n) {
    const int index = index_at(range - static_cast<float>(n) * GroundGrid::kCell);
    if (index != last) vote(index, range, cue, ground);
    last = index;
  }
  return cue;
}

void Drops::below(const View& view, const Eigen::Vector3f& point, const GroundGrid& ground) {
  const Eigen::Vector3f ray = point - view.sensor;
  const float range = ray.head<2>().norm();
  // A return that is not lower than the ground around the robot lies behind something higher. A return below
  // an obstacle may be its reflection in wet ground or glass.
  const auto solid_at = [&](float r) {
    const Eigen::Vector2f p = point.head<2>() + (r - range) / range * ray.head<2>();
    return ground.inside(p.x(), p.y()) && solid_[ground.window(p.x(), p.y())] != 0;
  };
  const bool under_solid = solid_at(range) || solid_at(range + GroundGrid::kCell);
  const float depth = ground.below_plane(point);
  const Cue cue = depth <= 0                                ? Cue::level
                  : under_solid || depth <= geometry_.depth ? Cue::doubtful
                                                            : Cue::ray;
  if (ray.z() > -0.01f) return;
  const Cue passed = pass(view, ray, 1.0f, cue, ground);
  // There is no ground at the place of the return either.
  if (passed != Cue::none && range < farthest_ && ground.inside(point.x(), point.y()))
    vote(ground.window(point.x(), point.y()), range, passed, ground);
}

void Drops::turn_columns(const View& view) {
  Eigen::Vector2f ahead = view.turn.col(0).head<2>();
  const float length = ahead.norm();
  if (length < 1e-3f) return;
  ahead /= length;
  for (int c = 0; c < LidarRangeImage::kColumns; ++c) {
    const Eigen::Vector2f way = LidarRangeImage::direction_of(c);
    column_[c] = static_cast<std::uint8_t>(
        LidarRangeImage::column_of({ahead.dot(way), ahead.x() * way.y() - ahead.y() * way.x()}));
  }
}

void Drops::count_missing_returns(const View& view, const LidarRangeImage& rays, const GroundGrid& ground) {
  constexpr int kLevel = 48;  // Higher rows point upwards, or so far ahead that no return is expected.
  turn_columns(view);
  for (int row = 1; row < kLevel; ++row) {
    int count = 0;
    for (int c = 0; c < LidarRangeImage::kColumns; ++c) {
      const bool hit = !rays.empty_at(row, c);
      count += hit;
      returned_[at(row, c)] |= static_cast<std::uint8_t>(hit);
    }
    if (count == 0) continue;
    const Columns seen = count >= kRing && geometry_.rings > kSparse ? follow_ring(rays, row) : Columns{};
    for (int c = 0; c < LidarRangeImage::kColumns; ++c) {
      const int own = column_[c];
      std::uint8_t& missing = missing_returns_[at(row, c)];
      if (!rays.empty_at(row, own)) {
        missing = 0;
        continue;
      }
      if (!returned_[at(row, own)]) continue;
      // A ring on the border of two rows flickers, one that drifts is in another row, and a single ray may
      // fail.
      bool lonely = count < kRing || seen[own];
      for (int r = row - 1; r <= row + 1; ++r)
        for (int k = own - 1; k <= own + 1; ++k) lonely |= !rays.empty_at(r, k);
      if (lonely) {
        missing = 0;
        continue;
      }
      if (missing < kMissingReturns) ++missing;
      if (missing < kMissingReturns) continue;
      const Eigen::Vector2f way = LidarRangeImage::direction_of(own);
      const Eigen::Vector3f ray =
          view.turn * Eigen::Vector3f(way.x(), way.y(), LidarRangeImage::tangent_of(row));
      if (ray.z() < -kGrazing * ray.head<2>().norm()) pass(view, ray, farthest_, Cue::missing, ground);
    }
  }
}

void Drops::finish(const View& view, const LidarRangeImage& rays, const GroundGrid& ground) {
  cells_.clear();
  const auto window = static_cast<int>(ground.cells());
  if (!any_) return;
  any_ = false;
  for (int index = 0; index < window; ++index) {
    const std::size_t place = ground.place(index);
    float& odds = odds_[place];
    if (odds == 0) continue;
    any_ = true;
    if (ground.fresh(index)) {
      odds = std::max(std::min(odds, 0.0f) - kGround, kMinOdds);
      rays_below_[place] = 0;
      continue;
    }
    if (odds <= 0) continue;
    const Eigen::Vector2f middle = ground.middle(index);
    const Eigen::Vector3f seen = view.seen(middle.x(), middle.y(), ground.height(index));
    if (seen.z() < rays.lowest() * seen.head<2>().norm())
      stamp_[place] = now_;  // In the blind spot.
    else if (now_ - stamp_[place] > kDropMemory)
      odds = 0, rays_below_[place] = 0;
    if (odds >= kMinReported)
      cells_.push_back({static_cast<std::uint32_t>(index), 1 / (1 + std::exp(-odds))});
  }
}

}  // namespace adit::nav
