// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace adit::nav {

struct TerrainParams {
  double range{4.5};           ///< the terrain is known this far around the robot, m, [1, 20]
  double memory{4.0};          ///< an obstacle that is hidden is forgotten after, s, (0, 60]
  double ground_memory{60.0};  ///< the same for the height of the ground, s, (0, 600]
  double drop_memory{20.0};    ///< and for a drop that could be seen and is not, s, (0, 600]
  int misses{3};               ///< consecutive scans that saw through a cell before it is free, [1, 100]
  int silent{3};               ///< consecutive scans without a return where ground should give one, before
                               ///< that is a hole, [1, 100]
  double body_margin{0.02};    ///< returns this close around the footprint are the own body, m, [0, 0.5]
  double min_range{0.05};      ///< shorter returns are not returns, m, [0, 1]
  double blind_range{0.6};     ///< obstacles this near to the lidar are kept until rays went through them, m,
                               ///< [0, 2]
};

}  // namespace adit::nav
