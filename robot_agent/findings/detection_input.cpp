// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/findings/detection_input.hpp"

#include "core/wire/topics.hpp"
#include "robot_agent/findings/detection_messages.hpp"
#include "vision_msgs/msg/Detection3DArray.h"

namespace adit::agent {

DetectionInput::DetectionInput(DetectionParams params, const std::string& robot, const Platform& platform,
                               std::shared_ptr<StaticFrames> frames, FindingSource& findings, Outputs outputs)
    : params_(params),
      placer_(platform, std::move(frames)),
      reporter_(std::move(params), robot, findings),
      refusals_(std::move(outputs.fault)) {}

Result<void> DetectionInput::open(const wire::ComponentIo& io) {
  names_.reserve(params_.topics.size());  // The topics refer to the names.
  for (const std::string& topic : params_.topics) {
    wire::Topic<vision_msgs::msg::Detection3DArray> named = wire::topics::kDetections;
    named.name = names_.emplace_back("rt/" + topic).c_str();
    const auto take_it = [this, topic](const vision_msgs::msg::Detection3DArray& message,
                                       const wire::SampleInfo& info) {
      take(message, topic, wire::to_string(info.sender), info.received);
    };
    if (auto opened = io.open(readers_.emplace_back(), named, take_it); !opened) return opened.error();
  }
  return {};
}

void DetectionInput::take(const vision_msgs::msg::Detection3DArray& message, const std::string& topic,
                          const std::string& sender, Time received) {
  if (!first_) first_ = received;
  ++messages_;
  auto all = detections_of(message, topic + " " + sender, params_,
                           [&](const Error& why) { refusals_.refuse(topic, why); });
  if (!all) return refusals_.refuse(topic, all.error());
  for (Detection& each : *all) {
    if (waiting_.size() >= kWaiting) {
      refusals_.refuse(waiting_.front().topic,
                       {Reason::queue_full, "more objects than can wait for odometry"});
      waiting_.pop_front();
    }
    waiting_.push_back({std::move(each), topic, messages_, received});
  }
}

void DetectionInput::tick(const RobotPlace& place, Time now) {
  std::deque<Waiting> later;
  while (!waiting_.empty()) {
    Waiting next = std::move(waiting_.front());
    waiting_.pop_front();
    if (ObjectPlacer::must_wait(next.detection, next.received, place.frames, now)) {
      later.push_back(std::move(next));
      continue;
    }
    const auto at = placer_.placed(next.detection, place);
    const bool frames_come = first_ && now - *first_ < kFramesCome;
    if (!at && at.reason() == Reason::frame_unknown && frames_come) {
      later.push_back(std::move(next));
      continue;
    }
    const auto taken = at ? reporter_.take(next.detection, *at, next.message, now) : Result<void>(at.error());
    if (!taken) refusals_.refuse(next.topic, taken.error());
  }
  waiting_ = std::move(later);
}

void DetectionInput::look(const wire::Participant& wire) {
  refusals_.look(wire, params_.topics,
                 "a message is no vision_msgs/msg/Detection3DArray, or has more than " +
                     std::to_string(wire::topics::kDetections.max_bytes / 1024) + " kB");
}

}  // namespace adit::agent
