// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/motion/pose_history.hpp"

namespace adit::agent {

void PoseHistory::add(std::uint64_t stamp, const Pose3& pose) {
  if (stamp == 0) return;
  std::size_t at = size_;
  while (at > 0 && sample(at - 1).stamp > stamp) --at;
  if (at > 0 && sample(at - 1).stamp == stamp) return;
  if (size_ == kCapacity) {
    if (at == 0) return;
    first_ = (first_ + 1) % kCapacity;
    --size_;
    --at;
  }
  ++size_;
  for (std::size_t n = size_ - 1; n > at; --n) sample(n) = sample(n - 1);
  sample(at) = {stamp, pose};
}

Result<Pose3> PoseHistory::at(std::uint64_t stamp) const {
  const Error outside{Reason::out_of_range, "no pose is known at that time"};
  if (size_ == 0 || stamp < sample(0).stamp || stamp > newest()) return outside;
  std::size_t low = 0, high = size_ - 1;  // The last sample not after `stamp` is in [low, high].
  while (low < high) {
    const std::size_t middle = (low + high + 1) / 2;
    if (sample(middle).stamp <= stamp)
      low = middle;
    else
      high = middle - 1;
  }
  const HistoryPose& before = sample(low);
  if (before.stamp == stamp) return before.pose;
  const HistoryPose& after = sample(low + 1);
  const std::uint64_t gap = after.stamp - before.stamp;
  if (gap > kLongestGap) return outside;
  const double part = static_cast<double>(stamp - before.stamp) / static_cast<double>(gap);
  return Pose3{before.pose.position + part * (after.pose.position - before.pose.position),
               before.pose.orientation.slerp(part, after.pose.orientation)};
}

}  // namespace adit::agent
