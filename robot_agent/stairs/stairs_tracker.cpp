// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/stairs/stairs_tracker.hpp"

#include <algorithm>
#include <array>

#include "core/findings/merge_stairs.hpp"

namespace adit::agent {

Staircase with_least_sigma(Staircase s) {
  s.sigma.place = std::max(s.sigma.place, 0.02);
  s.sigma.heading = std::max(s.sigma.heading, 0.005);
  s.sigma.rise = std::max(s.sigma.rise, 0.002);
  s.sigma.run = std::max(s.sigma.run, 0.003);
  s.sigma.width = std::max(s.sigma.width, 0.02);
  return s;
}

bool differs(const Staircase& a, const Staircase& b) {
  return a.steps != b.steps || std::abs(a.rise - b.rise) > 0.01 || std::abs(a.run - b.run) > 0.01 ||
         std::abs(a.width - b.width) > 0.1 || (a.foot - b.foot).norm() > 0.1 ||
         std::abs(std::remainder(a.heading - b.heading, 2 * M_PI)) > 0.05;
}

void StairsTracker::take(std::span<const Staircase> seen, const Eigen::Vector3d& from) {
  ++clouds_;
  for (const Staircase& one : seen) {
    const auto track = std::find_if(tracks_.begin(), tracks_.end(), [&](const Track& known) {
      return findings::is_same_flight(known.stairs, one);
    });
    if (track == tracks_.end()) {
      if (tracks_.size() >= kMost)
        tracks_.erase(std::min_element(tracks_.begin(), tracks_.end(),
                                       [](const Track& a, const Track& b) { return a.seen < b.seen; }));
      tracks_.push_back({.id = ++next_, .stairs = with_least_sigma(one), .from = from, .seen = clouds_});
      continue;
    }
    const std::array<findings::SeenStairs, 2> both{{{.stairs = track->stairs}, {.stairs = one}}};
    track->stairs = with_least_sigma(findings::combined(both));
    track->seen = clouds_;
    if ((from - track->from).norm() >= kApart) {
      track->from = from;
      ++track->places;
    }
  }
}

std::vector<StairsTracker::Tracked> StairsTracker::confirmed() const {
  std::vector<Tracked> out;
  for (const Track& track : tracks_)
    if (track.places >= kConfirmed) out.push_back({track.id, track.stairs});
  return out;
}

}  // namespace adit::agent
