// SPDX-License-Identifier: Apache-2.0
#include "perception/input/frame_tree.hpp"

#include <cmath>

namespace adit::perception {

std::string frame_name(const std::string& name) { return name.starts_with('/') ? name.substr(1) : name; }

Result<void> FrameTree::set(const std::string& parent, const std::string& child,
                            const Pose3& T_parent_child) {
  const std::string from = frame_name(parent), name = frame_name(child);
  if (from.empty() || name.empty() || from == name)
    return {Reason::malformed, "a transform of '" + child + "' in '" + parent + "' is none"};
  const bool usable =
      T_parent_child.position.allFinite() &&
      std::fabs(T_parent_child.orientation.norm() - 1.0) < 1e-2;  // False for what is no number.
  if (!usable)
    return {Reason::malformed, "the transform of '" + child + "' has no position and unit quaternion"};
  if (frames_.size() >= kCapacity && !frames_.contains(name))
    return {Reason::queue_full, "more than " + std::to_string(kCapacity) + " fixed frames"};
  frames_[name] = {from, {T_parent_child.position, T_parent_child.orientation.normalized()}};
  return {};
}

Result<Pose3> FrameTree::find(const std::string& target, const std::string& frame) const {
  const std::string goal = frame_name(target), start = frame_name(frame);
  // From every ancestor of the target, the way down to the target. A circle ends with the number of frames.
  std::map<std::string, Pose3> T_ancestor_target{{goal, Pose3{}}};
  Pose3 T{};
  std::string at = goal;
  for (std::size_t n = 0; n < frames_.size() && frames_.contains(at); ++n) {
    const Frame& each = frames_.at(at);
    T = each.T_parent_child * T;
    at = each.parent;
    if (!T_ancestor_target.emplace(at, T).second) break;
  }
  T = {};
  at = start;
  for (std::size_t n = 0; n <= frames_.size(); ++n) {
    if (const auto common = T_ancestor_target.find(at); common != T_ancestor_target.end())
      return common->second.inverse() * T;
    const auto up = frames_.find(at);
    if (up == frames_.end()) break;
    T = up->second.T_parent_child * T;
    at = up->second.parent;
  }
  return Error{Reason::frame_unknown, "the frame '" + frame + "' is not connected to '" + target + "'"};
}

}  // namespace adit::perception
