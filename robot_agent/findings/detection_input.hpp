// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/config/platform.hpp"
#include "core/wire/component_io.hpp"
#include "robot_agent/findings/detection.hpp"
#include "robot_agent/findings/detection_reporter.hpp"
#include "robot_agent/motion/frames.hpp"
#include "robot_agent/motion/input_faults.hpp"
#include "robot_agent/motion/static_frames.hpp"

namespace vision_msgs::msg {
class Detection3DArray;
}

namespace adit::agent {

/// Where the robot is, for places of objects.
struct RobotPlace {
  const Frames& frames;
  Pose3 T_odom_driver{};         ///< See PoseCorrection.
  Reason unknown{Reason::none};  ///< Why the pose must not be used.
};

/// Reads the objects that programs on the robot detect, from the robot domain. Each waits until the odometry
/// is as new as its stamp, is placed in the map, and goes to the DetectionReporter. What cannot be used is
/// refused with its reason and counted by topic. Outlives the command component and runs on its strand.
class DetectionInput {
 public:
  static constexpr std::size_t kWaiting = 1024;  ///< Objects that wait for odometry.
  static constexpr Duration kPatience = 500ms;   ///< For odometry as new as a stamp.
  static constexpr Duration kFramesCome = 3s;    ///< After the first message, /tf_static may still come.
  static constexpr std::uint64_t kAhead =
      500'000'000;  ///< A stamp that is newer than the odometry by more, ns.

  struct Outputs {
    std::function<void(const InputFault&)> fault{};
  };

  DetectionInput(DetectionParams params, const std::string& robot, const Platform& platform,
                 std::shared_ptr<StaticFrames> frames, FindingSource& findings, Outputs outputs);

  /// Opens the readers. Errors: those of the participant.
  Result<void> open(const wire::ComponentIo& io);
  void close() { readers_.clear(); }

  /// Takes a message. `topic`: without rt/.
  void take(const vision_msgs::msg::Detection3DArray& message, const std::string& topic,
            const std::string& sender, Time received);
  /// Places what need not wait any longer, and reports it. At 10 Hz or more.
  void tick(const RobotPlace& place, Time now);
  /// Reports messages that the wire could not decode. About once a second.
  void look(const wire::Participant& wire);

  /// Objects and messages that were refused, over all topics.
  std::uint64_t refused() const;
  const DetectionReporter& reporter() const { return reporter_; }

 private:
  struct Waiting {
    Detection detection{};
    std::string topic{};
    std::uint64_t message{};
    Time received{};
  };
  void refuse(const std::string& topic, const Error& why);
  bool must_wait(const Waiting& waiting, const Frames& frames, Time now) const;
  /// The place in the map, m.
  Result<Eigen::Vector3d> placed(const Detection& detection, const RobotPlace& place) const;
  /// T_odom_base at the stamp of a detection.
  Result<Pose3> pose_at(const Detection& detection, const Frames& frames) const;
  /// T_base_frame. Errors: frame_unknown.
  Result<Pose3> mounting(const std::string& frame) const;

  DetectionParams params_;
  Platform platform_;
  std::shared_ptr<StaticFrames> static_frames_;
  DetectionReporter reporter_;
  Outputs outputs_;
  std::vector<std::string> names_{};  ///< DDS names of the topics.
  std::vector<std::unique_ptr<wire::RawReader>> readers_{};
  std::deque<Waiting> waiting_{};
  std::map<std::string, std::uint64_t> refused_{};    ///< By topic.
  std::map<std::string, std::uint64_t> malformed_{};  ///< By topic, as the wire counted at the last look.
  std::optional<Time> first_{};                       ///< When the first message came.
  std::uint64_t messages_{};
};

}  // namespace adit::agent
