// SPDX-License-Identifier: Apache-2.0
#include "sim/truth/repeated_way.hpp"

#include <algorithm>
#include <cmath>

namespace adit::sim {
namespace {

Eigen::Vector2i square_of(const Eigen::Vector2d& position) {
  return (position / RepeatedWay::kNear).array().floor().cast<int>();
}

std::uint64_t key_of(const Eigen::Vector2i& square) {
  return static_cast<std::uint64_t>(static_cast<std::uint32_t>(square.x())) << 32 |
         static_cast<std::uint32_t>(square.y());
}

}  // namespace

bool RepeatedWay::was_here(const Eigen::Vector2d& position, double before_s) const {
  const Eigen::Vector2i middle = square_of(position);
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) {
      const auto found = places_.find(key_of(middle + Eigen::Vector2i(dx, dy)));
      if (found == places_.end()) continue;
      if (std::any_of(found->second.begin(), found->second.end(), [&](const Place& place) {
            return place.time_s < before_s && (place.position - position).norm() <= kNear;
          }))
        return true;
    }
  return false;
}

void RepeatedWay::add(std::size_t robot, double time_s, const Eigen::Vector2d& position) {
  std::optional<Track>& track = tracks_[robot];
  if (track) {
    const double way = (position - track->now).norm();
    metres_ += way;
    if (way > 0 && was_here(position, time_s - kOld)) repeated_ += way;
    track->now = position;
    if ((position - track->recorded).norm() < kApart) return;
  }
  places_[key_of(square_of(position))].push_back({position, time_s});
  track = Track{position, position};
}

}  // namespace adit::sim
