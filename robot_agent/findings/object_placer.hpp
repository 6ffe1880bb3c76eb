// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>

#include "core/config/platform.hpp"
#include "robot_agent/findings/detection.hpp"
#include "robot_agent/motion/frames.hpp"
#include "robot_agent/motion/static_frames.hpp"

namespace adit::agent {

/// Where the robot is, for places of objects.
struct RobotPlace {
  const Frames& frames;
  Pose3 T_odom_driver{};         ///< See PoseCorrection.
  Reason unknown{Reason::none};  ///< Why the pose must not be used.
};

/// Places objects that programs on the robot report: from their frame, with the robot's pose at their stamp,
/// in the map.
class ObjectPlacer {
 public:
  static constexpr Duration kPatience = 500ms;  ///< For odometry as new as a stamp.
  static constexpr std::uint64_t kAhead =
      500'000'000;  ///< A stamp that is newer than the odometry by more, ns.

  ObjectPlacer(const Platform& platform, std::shared_ptr<StaticFrames> frames)
      : platform_(platform), static_frames_(std::move(frames)) {}

  /// Whether the odometry may soon be as new as the object's stamp.
  static bool must_wait(const Detection& detection, Time received, const Frames& frames, Time now);
  /// The place in the map, m. Errors: driver_silent, sensor_times, frame_unknown, RobotPlace::unknown.
  Result<Eigen::Vector3d> placed(const Detection& detection, const RobotPlace& place) const;

 private:
  /// T_odom_base at the stamp of a detection.
  static Result<Pose3> pose_at(const Detection& detection, const Frames& frames);
  /// T_base_frame. Errors: frame_unknown.
  Result<Pose3> mounting(const std::string& frame) const;

  Platform platform_;
  std::shared_ptr<StaticFrames> static_frames_;
};

}  // namespace adit::agent
