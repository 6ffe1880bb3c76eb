// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "basestation/gui/scene/floors.hpp"
#include "basestation/gui/scene/mark_list.hpp"
#include "basestation/gui/scene/orbit_camera.hpp"
#include "basestation/model/found.hpp"
#include "basestation/model/stairs.hpp"

namespace adit::gui {

/// Where a place of the map frame, m, is on the screen; nothing if it is behind the camera.
using Projection = std::function<std::optional<Point>(const Point3&)>;

/// What the marks depend on that both views of the map have below the robots.
struct LayerScene {
  const station::World* world{};
  const station::FoundReport* found{};
  const station::StairsReport* stairs{};
  std::uint32_t picked{};  ///< Number of the finding that the operator picked; 0: none.
  Projection project{};
  bool from_side{};  ///< Heights are seen.
  const Floors* floors{};
  std::optional<std::size_t> floor{};  ///< The one that is shown; nothing: all.
  double mm{3.78};                     ///< Pixels per mm.
};

/// Ribbons of staircases. Stars of findings, flags of operators' marks: a rejected or withdrawn one has none,
/// that of a confirmed one is filled, and what is part of a staircase has no star. Lines through the robots
/// of convoys in their order, with the place of each one.
MarkList layer_marks(const LayerScene& scene);

/// Arrows beside the robots that are on other floors than the one that is shown, with the floor's name.
MarkList floor_marks(const LayerScene& scene);

/// The flag of a mark that is not sent yet. `at`: pixels. `mm`: pixels per mm.
void add_flag(MarkList& marks, const Point& at, double mm);

/// Puts more marks above those of a list.
void append(MarkList& marks, MarkList more);

}  // namespace adit::gui
