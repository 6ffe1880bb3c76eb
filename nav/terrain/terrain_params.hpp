// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace adit::nav {

/// Parameters of TerrainMap.
struct TerrainParams {
  double range{4.5};           ///< Radius of the terrain map around the robot, m, [1, 20].
  double memory{4.0};          ///< Lifetime of a hidden obstacle, s, (0, 60].
  double ground_memory{60.0};  ///< Lifetime of a ground height, s, (0, 600].
  double drop_memory{20.0};    ///< Lifetime of a drop that could be seen and is not, s, (0, 600].
  int free_hits{3};            ///< Consecutive scans that saw through a cell before it is free, [1, 100].
  /// Consecutive scans without an expected return of the ground before it counts as a hole, [1, 100].
  int missing_returns{3};
  double min_range{0.05};  ///< Shorter ranges are no returns, m, [0, 1].
  /// Within this distance of the lidar obstacles stay until rays pass through them, m, [0, 2].
  double blind_range{0.6};
};

}  // namespace adit::nav
