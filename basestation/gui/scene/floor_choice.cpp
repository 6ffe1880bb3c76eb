// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/scene/floor_choice.hpp"

#include <algorithm>
#include <cmath>

namespace adit::gui {

void FloorChoice::update(const Floors& floors, const station::World& world,
                         const std::vector<std::string>& selection) {
  const std::vector<Floor>& all = floors.floors();
  if (all.size() < 2) {
    shown_.reset();
    label_.clear();
    return;
  }
  if (!height_)
    for (const Floor& floor : all)
      if (floor.name == "0") height_ = floor.z;
  if (kind_ == Kind::automatic && !selection.empty())
    if (const station::Robot* robot = world.robot(selection.back()); robot && robot->located)
      if (const auto floor = floors.floor_at(robot->z)) height_ = all[*floor].z;
  const double height = height_.value_or(0.0);
  std::size_t nearest = 0;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (std::abs(all[i].z - height) < std::abs(all[nearest].z - height)) nearest = i;
  shown_ = nearest;
  height_ = all[nearest].z;
  label_ = kind_ == Kind::all ? "all floors"
                              : "floor " + all[nearest].name + (kind_ == Kind::automatic ? ", auto" : "");
}

void FloorChoice::move(int steps, const Floors& floors) {
  if (!shown_) return;
  const int last = static_cast<int>(floors.floors().size()) - 1;
  // From all floors, the first step shows the one that was shown before.
  const int to = static_cast<int>(*shown_) + (kind_ == Kind::all ? 0 : steps);
  kind_ = Kind::chosen;
  height_ = floors.floors()[static_cast<std::size_t>(std::clamp(to, 0, last))].z;
}

void FloorChoice::show_height(double z, const Floors& floors) {
  const auto floor = floors.floor_at(z);
  if (!floor || !shown_ || kind_ == Kind::all || *floor == *shown_) return;
  kind_ = Kind::chosen;
  height_ = floors.floors()[*floor].z;
}

}  // namespace adit::gui
