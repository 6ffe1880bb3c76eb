// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "basestation/gui/scene/height_colours.hpp"
#include "basestation/gui/scene/mark_list.hpp"
#include "basestation/gui/scene/orbit_camera.hpp"

namespace adit::gui {

/// What the marks of the view from the side depend on.
struct OrbitScene {
  const station::World* world{};
  const Trails* trails{};
  OrbitCamera camera{};
  Slice slice{};  ///< The heights that are shown: robots below and above it are pale.
  std::vector<std::string> selection{};
  std::vector<Point3> ghosts{};  ///< Goals that would be sent, map frame, m.
  double silent{};               ///< Time since the station's last snapshot, s.
  double mm{3.78};               ///< Pixels per mm.
};

/// Whether something at that height, m, stands in a slice.
inline bool stands_in(const Slice& slice, double z) { return z >= slice.low - 0.3 && z <= slice.high; }

/// The marks of a world above the picture of its voxels: what is behind a wall is seen through it.
MarkList orbit_marks(const OrbitScene& scene);

}  // namespace adit::gui
