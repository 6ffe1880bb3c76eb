// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/stairs/stairs_tracker.hpp"

#include <algorithm>
#include <array>

#include "core/findings/merge_stairs.hpp"

namespace adit::agent {
namespace {

/// Clouds of one robot share the errors of its odometry: no number of them makes a flight more certain than
/// this.
Staircase with_least_sigma(Staircase s) {
  s.sigma.place = std::max(s.sigma.place, 0.02);
  s.sigma.heading = std::max(s.sigma.heading, 0.005);
  s.sigma.rise = std::max(s.sigma.rise, 0.002);
  s.sigma.run = std::max(s.sigma.run, 0.003);
  s.sigma.width = std::max(s.sigma.width, 0.02);
  return s;
}

/// Whether an operator or a robot that climbs would want to know.
bool differs(const Staircase& a, const Staircase& b) {
  return a.steps != b.steps || std::abs(a.rise - b.rise) > 0.01 || std::abs(a.run - b.run) > 0.01 ||
         std::abs(a.width - b.width) > 0.1 || (a.foot - b.foot).norm() > 0.1 ||
         std::abs(std::remainder(a.heading - b.heading, 2 * M_PI)) > 0.05;
}

}  // namespace

std::vector<Staircase> StairsTracker::take(std::span<const Staircase> seen, const Eigen::Vector3d& from) {
  ++clouds_;
  std::vector<Staircase> out;
  for (const Staircase& one : seen) {
    const auto track = std::find_if(tracks_.begin(), tracks_.end(), [&](const Track& known) {
      return findings::is_same_flight(known.stairs, one);
    });
    if (track == tracks_.end()) {
      if (tracks_.size() >= kMost)
        tracks_.erase(std::min_element(tracks_.begin(), tracks_.end(),
                                       [](const Track& a, const Track& b) { return a.seen < b.seen; }));
      tracks_.push_back({.stairs = with_least_sigma(one), .from = from, .seen = clouds_});
      continue;
    }
    const std::array<findings::SeenStairs, 2> both{{{.stairs = track->stairs}, {.stairs = one}}};
    track->stairs = with_least_sigma(findings::combined(both));
    track->seen = clouds_;
    if ((from - track->from).norm() >= kApart) {
      track->from = from;
      ++track->places;
    }
    if (track->places < kConfirmed || (track->reported && !differs(*track->reported, track->stairs)))
      continue;
    track->reported = track->stairs;
    out.push_back(track->stairs);
  }
  return out;
}

std::vector<Staircase> StairsTracker::confirmed() const {
  std::vector<Staircase> out;
  for (const Track& track : tracks_)
    if (track.places >= kConfirmed) out.push_back(track.stairs);
  return out;
}

}  // namespace adit::agent
