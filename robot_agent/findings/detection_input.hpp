// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/wire/component_io.hpp"
#include "robot_agent/findings/detection.hpp"
#include "robot_agent/findings/detection_reporter.hpp"
#include "robot_agent/findings/object_placer.hpp"
#include "robot_agent/findings/topic_refusals.hpp"

namespace vision_msgs::msg {
class Detection3DArray;
}

namespace adit::agent {

/// Reads the objects that programs on the robot detect, from the robot domain. Each waits until the odometry
/// is as new as its stamp, is placed in the map, and goes to the DetectionReporter. What cannot be used is
/// refused with its reason and counted by topic. Outlives the command component and runs on its strand.
class DetectionInput {
 public:
  static constexpr std::size_t kWaiting = 1024;  ///< Objects that wait for odometry.
  static constexpr Duration kFramesCome = 3s;    ///< After the first message, /tf_static may still come.

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
  std::uint64_t refused() const { return refusals_.count(); }
  const DetectionReporter& reporter() const { return reporter_; }

 private:
  struct Waiting {
    Detection detection{};
    std::string topic{};
    std::uint64_t message{};
    Time received{};
  };

  DetectionParams params_;
  ObjectPlacer placer_;
  DetectionReporter reporter_;
  TopicRefusals refusals_;
  std::vector<std::string> names_{};  ///< DDS names of the topics.
  std::vector<std::unique_ptr<wire::RawReader>> readers_{};
  std::deque<Waiting> waiting_{};
  std::optional<Time> first_{};  ///< When the first message came.
  std::uint64_t messages_{};
};

}  // namespace adit::agent
