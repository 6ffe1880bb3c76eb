// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "perception/map/voxel_image.hpp"

namespace adit::perception {

/// A level of a building or mine: connected ground that never lies above itself.
struct Floor {
  double height{};  ///< Where most of its ground is, m.
  std::vector<VoxelIndex>
      ground{};  ///< Occupied voxels with free space above, one a column, by rising index.
};

/// The floors, from the lowest up. Ground is connected where it rises by at most `max_step` m from column to
/// column; a floor takes in ramps and stairs until they lie above its own ground, where the next floor
/// begins. Floors of less than `min_area` m2 are left out.
std::vector<Floor> find_floors(const VoxelImage& image, double max_step = 0.25, double min_area = 4.0);

}  // namespace adit::perception
