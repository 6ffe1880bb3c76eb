// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace adit::nav {

/// Parameters of the global planner and its map.
struct RouteParams {
  double range{20.0};        ///< Maximum range of the scan points used, m, [2, 60].
  double comfort{0.4};       ///< Inflation beyond the body where there is room, m, [0, 0.5].
  double narrow_cost{2.0};   ///< Additional cost per metre without that room, m, [0, 4].
  double unknown_cost{1.2};  ///< Cost of a metre of unknown space, m, [1, 3].
  double level_cost{8.0};    ///< Cost of 1.5 m of height through unknown space, m, [0, 100].
  /// Cost of a metre over what looks like a step from afar only, m, [1, 15].
  double doubtful_cost{2.0};
  /// The same for what looks like the edge of a hole, whose depth is unknown, m, [1, 15].
  double doubtful_hole_cost{12.0};
  double snap{0.5};            ///< Start and goal move to a passable place within this distance, m, [0, 1.5].
  bool through_unknown{true};  ///< Routes may cross unknown space; false: the map is complete.
  double margin{13.0};         ///< Usable unknown space around the known space, m, [2, 100].
  int rebuilds{64};  ///< Maximum number of tiles rebuilt after a scan, before a search, [0, 100000].
  /// Maximum number of tiles (1.6 x 1.6 m, 4.7 kB each); the farthest are dropped, [64, 20000].
  int tiles{12'288};
  double block_radius{0.30};  ///< Radius of a place that was found blocked, m, [0.1, 1].
  double block_time{20.0};    ///< Lifetime of a blocked place, doubled at each repetition, s, [1, 3600].
};

}  // namespace adit::nav
