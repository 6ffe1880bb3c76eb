#pragma once
#include "core/config/platform.hpp"

namespace adit {

/// What a body can drive over, under and between: the one set of limits that all layers judge the world by.
///
/// Derived once from the platform, so that no two layers disagree about what an obstacle is. Heights are
/// above the ground beside the thing, in gravity's axes. Of what flies only `headroom`, `half_width` and
/// `radius` count.
struct Traversability {
  double step{};        ///< Highest step that the body climbs, m.
  double obstacle{};    ///< A higher step than this, as the lidar measures it, is an obstacle, m: `step` and
                        ///< its noise.
  double slope{};       ///< Steepest ground, rise per run; of a body that climbs stairs, that of the stairs.
  double drop{};        ///< Ground that lies lower than the ground before it by more than this is a drop, m.
  double headroom{};    ///< What hangs at least this high above the ground is passed under, m.
  double half_width{};  ///< No gap narrower than twice this is passed, m.
  double radius{};      ///< A place with this much room around it can be turned on, m: half of the diagonal.
  double tilt{};        ///< Roll or pitch at which the body may tip over, rad.

  /// @param noise  Standard deviation of a lidar's range, m.
  static Traversability of(const Platform& platform, double noise);
  static Traversability of(const Platform& platform) { return of(platform, platform.lidar().noise); }
};

}  // namespace adit
