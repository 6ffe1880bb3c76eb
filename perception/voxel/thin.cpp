// SPDX-License-Identifier: Apache-2.0
#include "perception/voxel/thin.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "core/geometry/round_down.hpp"
#include "perception/voxel/flat_hash.hpp"

namespace adit::perception {

namespace {

std::uint64_t hash_of(std::uint64_t key) { return (key ^ key >> 32) * 0x9e3779b97f4a7c15ULL; }

}  // namespace

std::uint32_t& Thinner::slot(std::uint64_t key, std::uint64_t hash) {
  const std::size_t mask = slots_.size() - 1;
  std::size_t at = first_slot(hash);
  while (slots_[at] != kFree && voxels_[slots_[at]].key != key) at = (at + 1) & mask;
  return slots_[at];
}

void Thinner::clear_slots(std::size_t count) {
  slots_.assign(count, kFree);
  for (std::uint32_t n = 0; n < voxels_.size(); ++n) slot(voxels_[n].key, hash_of(voxels_[n].key)) = n;
}

void Thinner::take(const Place& place) {
  std::uint32_t& n = slot(place.key, place.hash);
  if (n == kFree) {
    n = static_cast<std::uint32_t>(voxels_.size());
    voxels_.push_back({place.key, 1});
    thinned_.push_back(*place.point);
    if (2 * voxels_.size() > slots_.size()) clear_slots(2 * slots_.size());
    return;
  }
  const std::uint32_t count = ++voxels_[n].points;
  const std::uint64_t draw = (place.hash + count) * 0xd1342543de82ef95ULL >> 32;
  if (draw * count >> 32 == 0) thinned_[n] = *place.point;  // With probability 1 / count.
}

const std::vector<Eigen::Vector3f>& Thinner::thin(std::span<const Eigen::Vector3f> points) {
  const float nearest = params_.min_range * params_.min_range,
              farthest = params_.max_range * params_.max_range;
  const bool first = edge_ == 0.0f;
  if (first) edge_ = 4 * params_.min_edge;
  // The first cloud finds its edge; later ones follow with one step each.
  for (int round = 0; round < (first ? 4 : 1); ++round) {
    thinned_.clear();
    voxels_.clear();
    // Twice as many voxels as wanted fill half of it.
    clear_slots(std::max(slots_.size(), std::bit_ceil(std::max<std::size_t>(1024, 4 * params_.wanted))));
    const float scale = 1.0f / edge_;
    // A block at a time: its slots are fetched while the keys of its other points are computed.
    constexpr std::size_t kBlock = 32;
    std::array<Place, kBlock> places;
    for (std::size_t begin = 0; begin < points.size(); begin += kBlock) {
      std::size_t count = 0;
      for (const Eigen::Vector3f& p : points.subspan(begin, std::min(kBlock, points.size() - begin))) {
        const float range = p.squaredNorm();
        // Negated, so that points that are not finite are left out.
        if (!(range >= nearest && range <= farthest)) continue;
        const auto index = [scale](float v) { return round_down(v * scale); };
        const std::uint64_t key = voxel_key(index(p.x()), index(p.y()), index(p.z()));
        const std::uint64_t hash = hash_of(key);
        __builtin_prefetch(&slots_[first_slot(hash)]);
        places[count++] = {&p, key, hash};
      }
      for (const Place& place : std::span(places).first(count)) take(place);
    }
    if (round + 1 == (first ? 4 : 1)) break;
    const float ratio = static_cast<float>(thinned_.size()) / static_cast<float>(params_.wanted);
    edge_ = std::clamp(edge_ * std::sqrt(ratio), params_.min_edge, params_.max_edge);
  }
  // Surfaces: the number of voxels falls with the square of the edge. Bounded, as one cloud may be odd.
  const float ratio = static_cast<float>(thinned_.size()) / static_cast<float>(params_.wanted);
  edge_ = std::clamp(edge_ * std::clamp(std::sqrt(ratio), 0.8f, 1.25f), params_.min_edge, params_.max_edge);
  return thinned_;
}

}  // namespace adit::perception
