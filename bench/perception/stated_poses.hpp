// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <deque>
#include <optional>
#include <vector>

#include "core/geometry/pose.hpp"
#include "core/time/time.hpp"
#include "sim/checker/observation.hpp"

namespace adit::bench {

/// The longest stretch of a condition.
struct Stretch {
  Duration longest{};
  Duration ended{};  ///< When the longest one ended, virtual time.

  void add(Duration now, bool holds);

 private:
  std::optional<Duration> since_{};
};

/// Compares the poses that a robot states on the radio with the truth. The map frame begins at the first
/// pose stated, as in the rule of honest poses (sim/checker/honest_pose.cpp).
class StatedPoses {
 public:
  void truth(Duration now, const Pose2& pose);             ///< World frame.
  void stated(Duration now, const sim::StateSent& state);  ///< As received.

  std::size_t claimed() const { return claimed_; }  ///< Poses stated as `ok` or `weak`.
  double ate() const;                          ///< Root mean square of the error of the claimed poses, m.
  double largest() const { return largest_; }  ///< Of those errors, m.
  double within() const;                       ///< Share of the claimed poses within three sigma, [0, 1].
  std::size_t within_count() const { return within_; }
  /// Claimed poses within three sigma of the truth at the very instant of the state, its delay included.
  std::size_t at_once() const { return at_once_; }
  const std::vector<double>& ratios() const { return ratios_; }  ///< Error by sigma of each claimed pose.
  double unclaimed() const;            ///< Share of the poses stated as `starting` or `lost`, [0, 1].
  double way() const { return way_; }  ///< True way, m.
  double end() const { return end_; }  ///< Error of the newest claimed pose, m.
  const Stretch& beyond() const { return beyond_; }  ///< Claimed, with an error above 5 sigma + 0.1 m.
  /// Not claimed, with such an error: navigation and operator see the pose all the same.
  const Stretch& silent() const { return silent_; }
  const Stretch& lost() const { return lost_; }  ///< `ok`, with an error above 5 sigma and 1 m.

 private:
  struct Past {
    Duration at{};
    Pose2 pose{};
  };
  std::deque<Past> past_{};           ///< True poses of late.
  std::optional<Pose2> reference_{};  ///< From the robot's map frame to the world.
  std::size_t states_{}, claimed_{}, within_{}, at_once_{};
  double squared_{}, largest_{}, way_{}, end_{};
  std::vector<double> ratios_{};
  Stretch beyond_{}, silent_{}, lost_{};
};

}  // namespace adit::bench
