// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "basestation/gui/scene/mark_list.hpp"
#include "basestation/gui/scene/orbit_camera.hpp"

namespace adit::gui {

/// How a robot's body is drawn from the side.
struct BodyStyle {
  Token fill{};
  bool dashed{};
  double opacity{1.0};
  double grow{1.0};  ///< Factor of its size.
};

/// A robot's body as a box of its size, turned and tilted as the robot is, with a wedge ahead. Wheels,
/// tracks, legs or rotors show its kind. `place`: base_link, on the ground or where it flies, map frame, m.
void add_body(MarkList& marks, const OrbitCamera& camera, const station::Robot& robot, const Point3& place,
              const BodyStyle& style);

/// Height of its body above base_link, m.
double tallness_of(const station::Robot& robot);

/// The directions x, y and z of the map frame as arrows from a point of the screen. `mm`: pixels per mm.
void add_axes(MarkList& marks, const OrbitCamera& camera, const Point& at, double mm);

}  // namespace adit::gui
