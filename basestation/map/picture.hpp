// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "core/geometry/pose.hpp"
#include "core/result/result.hpp"
#include "perception/map/voxel_image.hpp"

namespace adit::station {

/// The content of a picture of the map. Map frame, m.
struct MapPicture {
  struct Robot {
    std::string name{};
    std::string label{};         ///< Text in the legend.
    std::vector<Pose2> trail{};  ///< By time.
    Pose2 now{};
    double length{0.6}, width{0.5};  ///< Of the body, m.
  };
  std::string title{}, subtitle{};
  std::vector<Robot> robots{};
  int width{1600};  ///< Pixels, [400, 8000]; the height follows.
};

/// Draws the map from above: walls dark, the higher the darker; free ground light; what was not seen in the
/// colour of the paper; robots and their trails, a grid of the map's coordinates, and a scale bar.
/// Writes a PNG, which appears under its name when it is complete. Errors: map_empty, cannot_write,
/// bad_argument (the map is too large for a picture).
Result<void> write_map_picture(const perception::VoxelImage& image, const MapPicture& picture,
                               const std::string& file);

}  // namespace adit::station
