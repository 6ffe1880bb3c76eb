#pragma once
#include "core/config/platform.hpp"
#include "robot_agent/motion/kept_place.hpp"

namespace adit::agent {

/// Bounds how far a body can move between two odometry samples. A sample beyond that bound shows that the
/// odometry began again elsewhere: its driver was restarted, or its estimate was replaced.
class MotionBound {
 public:
  explicit MotionBound(const Platform& platform) : platform_(platform) {}

  /// Whether the body can have driven from the first pose to the second. The time between them is the larger
  /// one of what the receptions and, unless a sample would then have travelled for more than 1 s, the stamps
  /// say; stamps that go backwards say nothing. A robot whose odometry is silent is sent zero, so the time
  /// counts up to `unwatched` and the time for braking.
  ///
  /// @param unwatched  How long the body may drive after `from` before it is sent zero, (0, 10 s].
  bool reachable(const OdometrySample& from, const OdometrySample& to, Duration unwatched) const;

 private:
  Platform platform_;
};

}  // namespace adit::agent
