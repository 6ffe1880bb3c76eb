// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/config/platform.hpp"

namespace adit {

/// Limits of the terrain that a body can drive over, under and between; all layers use this one set.
///
/// It is derived once from the platform, so that all layers agree on what an obstacle is. Heights are above
/// the ground next to the object, along gravity. For an aerial robot only `headroom`, `half_width` and
/// `radius` count.
struct Traversability {
  /// Height of the lowest return of a stair's riser above its foot when seen from below, m.
  static constexpr double kRiser = 0.06;

  double step{};  ///< Highest step that the body climbs, m.
  /// A step higher than this, as the lidar measures it, is an obstacle, m: `step` plus noise.
  double obstacle{};
  double slope{};  ///< Steepest ground, rise per run; for a body that climbs stairs, that of the stairs.
  double drop{};   ///< Ground that is lower than the ground before it by more than this is a drop, m.
  /// The body passes under an obstacle that hangs at least this high above the ground, m.
  double headroom{};
  double half_width{};  ///< The body passes no gap narrower than twice this, m.
  double radius{};  ///< The body can turn where there is this much room around it, m: half of the diagonal.
  double tilt{};    ///< Roll or pitch at which the body may tip over, rad.

  /// @param noise  Standard deviation of a lidar's range, m.
  static Traversability of(const Platform& platform, double noise);
  static Traversability of(const Platform& platform) { return of(platform, platform.lidar().noise); }
};

}  // namespace adit
