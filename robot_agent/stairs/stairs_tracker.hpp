// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/geometry/staircase.hpp"
#include "perception/stairs/stairs_check.hpp"

namespace adit::agent {

/// Staircases over the clouds of a robot, in its odometry frame. One is confirmed once it was seen from three
/// places, or from two whose clouds have no scan in common; what is seen once may be rubble. Each further
/// sight refines it (information filter). A step at its end goes when the ground is level there, and the
/// staircase goes when rays pass through it, from several places. Pure.
class StairsTracker {
 public:
  /// A confirmed staircase, with a number that no other one of any tracker of this robot had.
  struct Tracked {
    std::uint64_t id{};
    Staircase stairs{};
    bool foot_known{}, top_known{};  ///< It was seen that there is no step beyond.
  };
  /// What a cloud shows of a track, by its id.
  using Checks = std::map<std::uint64_t, perception::StairsCheck>;
  static constexpr int kRefuted = 2;     ///< Places from which the ground is level where a step was counted.
  static constexpr int kGone = 3;        ///< Places from which rays pass through a staircase.
  static constexpr int kConfirmed = 3;   ///< Places from which it was seen.
  static constexpr double kApart = 0.3;  ///< Between them, m.
  /// Between two places that confirm, m: in the eight scans of a cloud, at 1.2 m/s, a robot moves by 0.84 m.
  static constexpr double kFarApart = 1.0;
  static constexpr std::size_t kMost = 64;  ///< Tracks; then the one that was seen longest ago is dropped.

  /// `instance`: number of this tracker since the start of the agent.
  explicit StairsTracker(std::uint32_t instance = 0) : next_(std::uint64_t{instance} << 32) {}

  /// Takes what one cloud shows. `from`: place of the robot, m.
  void take(std::span<const Staircase> seen, const Eigen::Vector3d& from, const Checks& checks = {});
  /// The odometry frame is another one.
  void clear() { tracks_.clear(); }
  /// The confirmed ones, as they are known best.
  std::vector<Tracked> confirmed() const;
  /// All, for checks; those that are not confirmed as well.
  std::vector<Tracked> all() const;
  /// Those that were confirmed and are gone, by id; each once.
  std::vector<std::uint64_t> take_withdrawn() { return std::exchange(withdrawn_, {}); }

 private:
  /// Places from which a riser was seen, and from which the ground was level instead.
  struct Votes {
    int there{}, level{};
    bool refuted() const { return level >= kRefuted && level > there; }
  };
  struct Track {
    std::uint64_t id{};
    Staircase stairs{};
    Eigen::Vector3d first{};  ///< Place of the first sight.
    Eigen::Vector3d from{};   ///< The last place that counted.
    int places{1};
    double spread{};     ///< Largest distance of a place from the first one, m.
    std::size_t seen{};  ///< Number of the cloud.
    std::optional<Eigen::Vector3d> checked_from{};
    int gone{};  ///< Places in a row from which rays pass through it.
    int foot{};  ///< Number of the lowest riser; keeps its meaning when steps are added below.
    std::map<int, Votes> risers{};

    bool is_confirmed() const { return places >= kConfirmed || spread >= kFarApart; }
    bool refuted(int riser) const;
    Tracked tracked() const;
  };
  static void combine(Track& track, const Staircase& one);
  /// Counts what a check shows of the ends that the track has now.
  static void vote_on_ends(Track& track, const perception::StairsCheck& check);
  /// Removes the ends that were refuted.
  static void trim(Track& track);
  std::vector<Track> tracks_{};
  std::vector<std::uint64_t> withdrawn_{};
  std::size_t clouds_{};
  std::uint64_t next_;
};

/// From riser to riser, m.
Eigen::Vector3d step_of(const Staircase& stairs);
/// Clouds of one robot share the errors of its odometry: no number of them makes a flight more certain than
/// this.
Staircase with_least_sigma(Staircase stairs);
/// Whether an operator, or a robot that climbs, would want to know.
bool differs(const Staircase& a, const Staircase& b);

}  // namespace adit::agent
