#include "core/config/traversability.hpp"

#include <algorithm>
#include <cmath>

namespace adit {
namespace {

/// Of a range's deviation: the top of a kerb is the highest of several returns, so that a kerb of exactly the
/// step is seen higher than that by less than one and a quarter.
constexpr double kStepNoise = 1.25;
/// The body bounces, and what hangs is seen from below as little as from above, m.
constexpr double kHeadroom = 0.15;
/// A body goes down farther than up: half a step more, and never stops for what the noise of far ground
/// shows, m.
constexpr double kDropPerStep = 1.5, kLeastDrop = 0.15;
/// On the steepest ground a body leans more by its suspension and by what one wheel stands on, rad.
constexpr double kLean = 0.25;
constexpr double kFlyingTilt = 1.0;  ///< What flies leans to accelerate, rad.

}  // namespace

Traversability Traversability::of(const Platform& platform, double noise) {
  Traversability t;
  t.step = platform.step;
  t.obstacle = platform.step + kStepNoise * noise;
  t.slope = platform.steepest();
  t.drop = std::max(kLeastDrop, kDropPerStep * platform.step);
  t.headroom = std::max(platform.height, platform.lidar_height) + kHeadroom;
  t.half_width = platform.width / 2;
  t.radius = std::hypot(platform.length, platform.width) / 2;
  t.tilt = platform.max_tilt > 0 ? platform.max_tilt
           : platform.flies()    ? kFlyingTilt
                                 : std::atan(t.slope) + kLean;
  return t;
}

}  // namespace adit
