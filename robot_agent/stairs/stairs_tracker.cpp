// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/stairs/stairs_tracker.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "core/findings/merge_stairs.hpp"

namespace adit::agent {

Eigen::Vector3d step_of(const Staircase& s) {
  const Eigen::Vector2d ahead = s.run * s.direction();
  return {ahead.x(), ahead.y(), s.rise};
}

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

bool StairsTracker::Track::refuted(int riser) const {
  const auto votes = risers.find(riser);
  return votes != risers.end() && votes->second.refuted();
}

StairsTracker::Tracked StairsTracker::Track::tracked() const {
  return {id, stairs, refuted(foot - 1), refuted(foot + stairs.steps)};
}

void StairsTracker::combine(Track& track, const Staircase& one) {
  const Staircase before = track.stairs;
  const std::array<findings::SeenStairs, 2> both{{{.stairs = before}, {.stairs = one}}};
  track.stairs = with_least_sigma(findings::combined(both));
  // Steps that were added below.
  const Eigen::Vector3d off = before.foot - track.stairs.foot;
  track.foot -=
      static_cast<int>(std::lround(off.dot(step_of(track.stairs)) / step_of(track.stairs).squaredNorm()));
  trim(track);
}

void StairsTracker::vote_on_ends(Track& track, const perception::StairsCheck& check) {
  using Riser = perception::StairsCheck::Riser;
  const auto vote = [&](int riser, Riser seen) {
    if (seen == Riser::there) ++track.risers[riser].there;
    if (seen == Riser::level) ++track.risers[riser].level;
  };
  vote(track.foot - 1, check.below);
  vote(track.foot, check.foot);
  vote(track.foot + track.stairs.steps - 1, check.top);
  vote(track.foot + track.stairs.steps, check.above);
  trim(track);
}

void StairsTracker::trim(Track& track) {
  Staircase& s = track.stairs;
  for (; s.steps > Staircase::kLeastSteps && track.refuted(track.foot); ++track.foot, --s.steps)
    s.foot += step_of(s);
  while (s.steps > Staircase::kLeastSteps && track.refuted(track.foot + s.steps - 1)) --s.steps;
}

void StairsTracker::take(std::span<const Staircase> seen, const Eigen::Vector3d& from, const Checks& checks) {
  ++clouds_;
  std::set<std::uint64_t> checked;
  for (Track& track : tracks_) {
    const auto check = checks.find(track.id);
    if (check == checks.end() || (track.checked_from && (from - *track.checked_from).norm() < kApart))
      continue;
    track.checked_from = from;
    checked.insert(track.id);
    // First, as the check is of the steps that were known before this cloud.
    vote_on_ends(track, check->second);
  }
  for (const Staircase& one : seen) {
    const auto track = std::find_if(tracks_.begin(), tracks_.end(), [&](const Track& known) {
      return findings::is_same_flight(known.stairs, one);
    });
    if (track == tracks_.end()) {
      if (tracks_.size() >= kMost)
        tracks_.erase(std::min_element(tracks_.begin(), tracks_.end(),
                                       [](const Track& a, const Track& b) { return a.seen < b.seen; }));
      tracks_.push_back(
          {.id = ++next_, .stairs = with_least_sigma(one), .first = from, .from = from, .seen = clouds_});
      continue;
    }
    combine(*track, one);
    track->seen = clouds_;
    track->gone = 0;
    if ((from - track->from).norm() >= kApart) {
      track->from = from;
      ++track->places;
      track->spread = std::max(track->spread, (from - track->first).norm());
    }
  }
  for (Track& track : tracks_) {
    if (!checked.contains(track.id)) continue;
    // Sight of equal steps is the stronger evidence.
    const bool gone = track.seen != clouds_ && checks.at(track.id).gone();
    track.gone = gone ? track.gone + 1 : 0;
  }
  std::erase_if(tracks_, [this](const Track& track) {
    if (track.gone < kGone) return false;
    if (track.is_confirmed()) withdrawn_.push_back(track.id);
    return true;
  });
}

std::vector<StairsTracker::Tracked> StairsTracker::confirmed() const {
  std::vector<Tracked> out;
  for (const Track& track : tracks_)
    if (track.is_confirmed()) out.push_back(track.tracked());
  return out;
}

std::vector<StairsTracker::Tracked> StairsTracker::all() const {
  std::vector<Tracked> out;
  for (const Track& track : tracks_) out.push_back(track.tracked());
  return out;
}

}  // namespace adit::agent
