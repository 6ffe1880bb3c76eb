// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/motion/fence.hpp"

#include <algorithm>

namespace adit::agent {

void Fence::convert(const nav::AreaSet& areas, const Frames& frames) {
  const bool others = !source_.same(areas);
  source_ = areas;
  map_epoch_ = frames.map_epoch();
  all_ = source_.in_frame(frames.T_map_odom().inverse(), frames.to_map(Eigen::Vector3d(0, 0, 0)).z());
  std::vector<Part> parts;
  nav::AreaSet inside = all_.only([](const nav::Area& a) { return a.kind == nav::AreaKind::keep_in; });
  if (!inside.empty()) parts.push_back({std::move(inside)});
  for (const nav::Area& area : all_.all())
    if (area.kind == nav::AreaKind::keep_out)
      parts.push_back({all_.only([&](const nav::Area& a) { return a.name == area.name; })});
  // A correction of the map changes where they are, but not which of them bind.
  for (std::size_t i = 0; i < parts.size() && !others; ++i) parts[i].binds = parts_[i].binds;
  parts_ = std::move(parts);
}

void Fence::update(const nav::AreaSet& areas, const Frames& frames) {
  if (areas.empty() && all_.empty()) return;
  bool changed = !source_.same(areas) || map_epoch_ != frames.map_epoch();
  if (changed) convert(areas, frames);
  const Eigen::Vector3d place = frames.T_odom_base().position;
  const Pose2 pose = frames.T_odom_base().planar();
  obeyed_ = all_.permits(nav::outline(platform_, pose), place.z());
  const auto wide = nav::outline(platform_, pose, nav::AreaSet::kMargin);
  for (Part& part : parts_) {
    const bool binds = part.binds ? part.areas.permits(place) : part.areas.permits(wide, place.z());
    changed = changed || binds != part.binds;
    part.binds = binds;
  }
  if (!changed) return;
  binding_ = all_.only([this](const nav::Area& area) {
    return std::any_of(parts_.begin(), parts_.end(),
                       [&](const Part& part) { return part.binds && part.areas.find(area.name); });
  });
}

std::vector<Eigen::Vector2f> Fence::border(const Frames& frames, double range) const {
  std::vector<Eigen::Vector2f> points;
  nav::sample_border(binding_, frames.T_odom_base().position, range, points);
  return points;
}

}  // namespace adit::agent
