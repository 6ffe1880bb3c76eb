// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "basestation/gui/scene/orbit_camera.hpp"

namespace adit::gui {

/// Room along the edges of a view that something else covers, pixels.
struct Margins {
  double left{}, top{}, right{}, bottom{};
};

/// The camera moved, but not turned, so that points of the map frame, m, fill the view within the margins as
/// far as its shape allows. Margins that would take more than `kMostMargin` of a side are made smaller.
OrbitCamera fitted(const OrbitCamera& camera, const std::vector<Point3>& points, Margins margins);
inline constexpr double kMostMargin = 0.18;

/// The box around points on the screen, pixels; empty if one of them is behind the camera.
struct ScreenBox {
  Point low{}, high{};
};
std::optional<ScreenBox> box_of(const OrbitCamera& camera, const std::vector<Point3>& points);

}  // namespace adit::gui
