// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <string>

#include "core/geometry/pose.hpp"
#include "core/result/result.hpp"

namespace adit::perception {

/// The fixed frames of a robot and how they hang together, as `tf_static` publishes them. Bounded.
class FrameTree {
 public:
  static constexpr std::size_t kCapacity = 128;  ///< Frames.

  /// Adds or replaces the transform of `child` in `parent`. Leading slashes are left out.
  /// Errors: malformed for a name that is empty or its own parent, and for a transform that is none;
  /// queue_full.
  Result<void> set(const std::string& parent, const std::string& child, const Pose3& T_parent_child);
  /// T_target_frame: where `frame` is in `target`, along the chain of parents of both.
  /// Error: frame_unknown, with both names, when no chain connects them.
  Result<Pose3> find(const std::string& target, const std::string& frame) const;
  std::size_t size() const { return frames_.size(); }

 private:
  struct Frame {
    std::string parent{};
    Pose3 T_parent_child{};
  };
  std::map<std::string, Frame> frames_{};
};

/// The name of a frame as it is compared: ROS 1 wrote a slash before it.
std::string frame_name(const std::string& name);

}  // namespace adit::perception
