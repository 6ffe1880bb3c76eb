// SPDX-License-Identifier: Apache-2.0
#include "nav/terrain/drops.hpp"

#include <cmath>

namespace adit::nav {
namespace {

constexpr int kBelieved = 3;                       ///< rays; fewer are reflections
constexpr float kFarthest = 4.0f;                  ///< m: beyond, rays are too far apart
constexpr float kNearest = 0.3f;                   ///< m
constexpr int kEdgeCells = 4;                      ///< between a ray's place and the last ground seen
constexpr int kRing = RayImage::kColumns * 3 / 8;  ///< directions in which a ring gives returns
constexpr std::uint8_t kUnknown = 255;

}  // namespace

Drops::Drops(const TerrainParams& params)
    : params_(params),
      votes_(GroundGrid::kTorus * GroundGrid::kTorus, 0),
      stamp_(GroundGrid::kTorus * GroundGrid::kTorus, 0.0f),
      quiet_(RayImage::kRows * RayImage::kColumns, kUnknown) {
  cells_.reserve(GroundGrid::kSide * GroundGrid::kSide);
}

void Drops::clear() {
  std::fill(votes_.begin(), votes_.end(), std::uint8_t{0});
  cells_.clear();
}

void Drops::begin_scan(const GroundGrid& ground, float now) {
  now_ = now;
  ground.entered([this](std::size_t place) { votes_[place] = 0; });
}

void Drops::vote(int index, int votes, const GroundGrid& ground) {
  const std::size_t place = ground.place(index);
  votes_[place] = static_cast<std::uint8_t>(std::min(votes_[place] + votes, 100));
  stamp_[place] = now_;
  any_ = true;
}

void Drops::pass(const View& view, const Eigen::Vector3f& ray, float end, int votes,
                 const GroundGrid& ground) {
  // Where the ray went below the ground, as far as that is level or bends little.
  float t = (ground.at(view.sensor.x() + end * ray.x(), view.sensor.y() + end * ray.y()) - view.sensor.z()) /
            ray.z();
  for (int i = 0; i < 3; ++i)
    t = (ground.at(view.sensor.x() + t * ray.x(), view.sensor.y() + t * ray.y()) - view.sensor.z()) / ray.z();
  const float length = std::sqrt(ray.x() * ray.x() + ray.y() * ray.y());
  const float range = t * length;
  if (!(t < end && range < kFarthest && range > kNearest)) return;
  const float ux = ray.x() / length, uy = ray.y() / length;
  int last = -1;
  for (int back = 0; back <= kEdgeCells; ++back) {
    const float r = range - static_cast<float>(back) * GroundGrid::kCell;
    if (r < kNearest) return;
    const int index = ground.window(view.sensor.x() + r * ux, view.sensor.y() + r * uy);
    if (index == last) continue;
    if (back > 0 && ground.measured(index)) return;
    vote(index, votes, ground);
    last = index;
  }
}

void Drops::below(const View& view, const Eigen::Vector3f& point, const GroundGrid& ground) {
  const Eigen::Vector3f ray = point - view.sensor;
  if (ray.head<2>().norm() < kFarthest) vote(ground.window(point.x(), point.y()), 1, ground);
  if (ray.z() < -0.01f) pass(view, ray, 1.0f, 1, ground);
}

void Drops::silent(const View& view, const RayImage& rays, const GroundGrid& ground) {
  constexpr int kLevel = 48;  // rows from here on look up, or so far ahead that nothing is expected
  for (int row = 1; row < kLevel; ++row) {
    int count = 0;
    for (int c = 0; c < RayImage::kColumns; ++c) count += !rays.empty_at(row, c);
    std::uint8_t* quiet = &quiet_[static_cast<std::size_t>(row * RayImage::kColumns)];
    for (int c = 0; c < RayImage::kColumns && count > 0; ++c) {
      if (!rays.empty_at(row, c)) {
        quiet[c] = 0;
        continue;
      }
      if (quiet[c] == kUnknown) continue;
      bool lonely = count < kRing;  // a ring on the border of two rows flickers; a single ray may fail
      for (int r = row - 1; r <= row + 1; ++r)
        for (int k = c - 1; k <= c + 1; ++k) lonely |= !rays.empty_at(r, k);
      if (lonely) {
        quiet[c] = 0;
        continue;
      }
      if (quiet[c] < params_.silent) ++quiet[c];
      if (quiet[c] < params_.silent) continue;
      const Eigen::Vector2f way = RayImage::direction_of(c);
      const Eigen::Vector3f ray = view.turn * Eigen::Vector3f(way.x(), way.y(), RayImage::tangent_of(row));
      if (ray.z() < -0.05f) pass(view, ray, kFarthest, kBelieved, ground);
    }
  }
}

void Drops::finish(const View& view, const RayImage& rays, const GroundGrid& ground) {
  cells_.clear();
  if (!any_) return;
  any_ = false;
  for (int index = 0; index < GroundGrid::kSide * GroundGrid::kSide; ++index) {
    const std::size_t place = ground.place(index);
    if (votes_[place] == 0) continue;
    if (ground.fresh(index)) {
      votes_[place] = 0;
      continue;
    }
    any_ = true;
    if (votes_[place] < kBelieved) continue;
    const Eigen::Vector2f at = ground.middle(index);
    const Eigen::Vector3f seen = view.seen(at.x(), at.y(), ground.height(index));
    if (seen.z() < rays.lowest() * seen.head<2>().norm())
      stamp_[place] = now_;  // in the blind spot
    else if (now_ - stamp_[place] > params_.drop_memory)
      votes_[place] = 0;
    if (votes_[place] > 0) cells_.push_back(static_cast<std::uint16_t>(index));
  }
}

}  // namespace adit::nav
