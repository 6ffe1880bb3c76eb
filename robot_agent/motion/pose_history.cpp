// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/motion/pose_history.hpp"

namespace adit::agent {

void PoseHistory::add(std::uint64_t stamp, const Pose3& pose) {
  if (stamp == 0 || (poses_.size() == kCapacity && stamp < poses_.begin()->first)) return;
  poses_.emplace(stamp, pose);
  if (poses_.size() > kCapacity) poses_.erase(poses_.begin());
}

Result<Pose3> PoseHistory::at(std::uint64_t stamp) const {
  const Error outside{Reason::out_of_range, "no pose is known at that time"};
  const auto after = poses_.lower_bound(stamp);
  if (after == poses_.end()) return outside;
  if (after->first == stamp) return after->second;
  if (after == poses_.begin()) return outside;
  const auto& [from, a] = *std::prev(after);
  const auto& [to, b] = *after;
  if (to - from > kLongestGap) return outside;
  const double part = static_cast<double>(stamp - from) / static_cast<double>(to - from);
  return Pose3{a.position + part * (b.position - a.position), a.orientation.slerp(part, b.orientation)};
}

}  // namespace adit::agent
