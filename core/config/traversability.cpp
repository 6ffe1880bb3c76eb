// SPDX-License-Identifier: Apache-2.0
#include "core/config/traversability.hpp"

#include <algorithm>
#include <cmath>

namespace adit {
namespace {

/// Margin in standard deviations of a range: the top of a kerb is the highest of several returns, which makes
/// a kerb of exactly the allowed step appear higher by less than this.
constexpr double kStepNoise = 1.25;
/// The body bounces, and the lidar measures overhanging obstacles from below no better than from above, m.
constexpr double kHeadroom = 0.15;
/// A body drives down higher steps than it climbs, by half a step. The minimum, m, keeps it from stopping for
/// the noise of distant ground.
constexpr double kDropPerStep = 1.5, kMinDrop = 0.15;
/// Extra lean on the steepest ground, from the suspension and from an obstacle under one wheel, rad.
constexpr double kLean = 0.25;
constexpr double kFlyingTilt = 1.0;  ///< An aerial robot leans to accelerate, rad.

}  // namespace

Traversability Traversability::of(const Platform& platform, double noise) {
  Traversability t;
  t.step = platform.step;
  t.obstacle = platform.step + kStepNoise * noise;
  t.slope = platform.steepest();
  t.drop = std::max(kMinDrop, kDropPerStep * platform.step);
  t.headroom = std::max(platform.height, platform.lidar_height) + kHeadroom;
  t.half_width = platform.width / 2;
  t.radius = std::hypot(platform.length, platform.width) / 2;
  t.tilt = platform.max_tilt > 0 ? platform.max_tilt
           : platform.flies()    ? kFlyingTilt
                                 : std::atan(t.slope) + kLean;
  return t;
}

}  // namespace adit
