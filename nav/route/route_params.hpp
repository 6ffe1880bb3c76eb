// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace adit::nav {

struct RouteParams {
  double range{20.0};        ///< of a scan, what it says farther away is not used, m, [2, 60]
  double comfort{0.4};       ///< kept beside the body where there is room, m, [0, 0.5]
  double narrow_cost{2.0};   ///< a metre without that room costs so many more, [0, 4]
  double unknown_cost{1.2};  ///< a metre of unknown space costs this many known ones, [1, 3]
  double level_cost{8.0};    ///< of 1.5 m up or down through unknown space, towards a goal there, m, [0, 100]
  double snap{0.5};          ///< a start or goal is moved to a passable place this near, m, [0, 1.5]
  bool through_unknown{true};  ///< unknown space may be tried; false: the map is complete
  double margin{13.0};         ///< unknown space is used this far around what is known, m, [2, 100]
  int rebuilds{64};   ///< tiles of the graph made anew with a scan before a search, at most, [0, 100000]
                      ///< them, [0, 100000]
  int tiles{12'288};  ///< of 1.6 x 1.6 m and 4.7 kB, at most; then the farthest go, [64, 20000]
  double block_radius{0.30};  ///< of a place that was found blocked, m, [0.1, 1]
  double block_time{20.0};    ///< it counts so long, and twice that when found so again, s, [1, 3600]
};

}  // namespace adit::nav
