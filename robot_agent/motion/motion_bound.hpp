// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/config/platform.hpp"
#include "robot_agent/motion/stored_frames.hpp"

namespace adit::agent {

/// Bounds how far a body can move between two odometry samples. A sample beyond that bound shows that the
/// odometry started again elsewhere: its driver was restarted, or its estimate was replaced.
class MotionBound {
 public:
  static constexpr double kFaster = 1.25;        ///< Downhill a body exceeds its platform's speed by so much.
  static constexpr double kNoise = 0.10;         ///< Position noise of one pose, m.
  static constexpr double kHeadingNoise = 0.15;  ///< Heading noise of one pose, rad.

  explicit MotionBound(const Platform& platform) : platform_(platform) {}

  /// Whether the body can have driven from the first pose to the second. The time between them is the larger
  /// one of the difference of the receptions and that of the stamps. The stamps are ignored if they run
  /// backwards, or if they imply a transport time of a sample above 1 s. A robot whose odometry is silent
  /// receives zero, so the time is limited to `unwatched` plus the braking time.
  ///
  /// @param unwatched  Maximum time that the body drives after `from` before it receives zero, (0, 10 s].
  bool reachable(const OdometrySample& from, const OdometrySample& to, Duration unwatched) const;

 private:
  Platform platform_;
};

}  // namespace adit::agent
