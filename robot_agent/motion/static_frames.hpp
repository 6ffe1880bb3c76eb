// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "core/geometry/pose.hpp"

namespace adit::agent {

/// The fixed frames that a driver sends once, on /tf_static. They may come before the sensors component is
/// made, and must outlive it: a driver does not repeat them. Bounded. Safe to call from any thread.
class StaticFrames {
 public:
  struct Frame {
    std::string parent{}, child{};
    Pose3 T_parent_child{};
  };

  /// Keeps a frame; a newer one of the same child replaces it.
  void keep(Frame frame) {
    const std::lock_guard lock(mutex_);
    if (frames_.size() >= kMost && !frames_.contains(frame.child)) return;
    const std::string child = frame.child;
    frames_[child] = std::move(frame);
  }
  std::vector<Frame> all() const {
    const std::lock_guard lock(mutex_);
    std::vector<Frame> out;
    for (const auto& [child, frame] : frames_) out.push_back(frame);
    return out;
  }

 private:
  static constexpr std::size_t kMost = 256;
  mutable std::mutex mutex_{};
  std::map<std::string, Frame> frames_{};
};

}  // namespace adit::agent
