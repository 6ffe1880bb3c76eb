// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/findings/detection_input.hpp"

#include <array>
#include <cstdio>

#include "core/wire/topics.hpp"
#include "perception/input/frame_tree.hpp"
#include "robot_agent/findings/detection_messages.hpp"
#include "vision_msgs/msg/Detection3DArray.h"

namespace adit::agent {
namespace {

double signed_seconds(std::uint64_t a, std::uint64_t b) {
  return static_cast<double>(static_cast<std::int64_t>(a - b)) * 1e-9;
}

Error wrong_stamp(const Detection& detection, double ahead) {
  std::array<char, 200> text{};
  if (detection.stamp == 0)
    std::snprintf(text.data(), text.size(),
                  "objects have no stamp: their program must set the time of the sensor's "
                  "data in the header");
  else
    std::snprintf(text.data(), text.size(),
                  "the stamps of objects are %.1f s %s the odometry, whose poses reach a few seconds back: "
                  "both need one clock, and the stamp of the sensor's data",
                  std::abs(ahead), ahead > 0 ? "ahead of" : "behind");
  return {Reason::sensor_times, text.data()};
}

}  // namespace

DetectionInput::DetectionInput(DetectionParams params, const std::string& robot, const Platform& platform,
                               std::shared_ptr<StaticFrames> frames, FindingSource& findings, Outputs outputs)
    : params_(params),
      platform_(platform),
      static_frames_(std::move(frames)),
      reporter_(std::move(params), robot, findings),
      outputs_(std::move(outputs)) {}

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
  auto all =
      detections_of(message, topic + " " + sender, params_, [&](const Error& why) { refuse(topic, why); });
  if (!all) return refuse(topic, all.error());
  for (Detection& each : *all) {
    if (waiting_.size() >= kWaiting) {
      refuse(waiting_.front().topic, {Reason::queue_full, "more objects than can wait for odometry"});
      waiting_.pop_front();
    }
    waiting_.push_back({std::move(each), topic, messages_, received});
  }
}

bool DetectionInput::must_wait(const Waiting& waiting, const Frames& frames, Time now) const {
  if (now - waiting.received >= kPatience) return false;
  if (!frames.initialised()) return true;
  const std::uint64_t newest = frames.newest_stamp(), stamp = waiting.detection.stamp;
  return newest != 0 && stamp > newest && stamp - newest <= kAhead;
}

void DetectionInput::tick(const RobotPlace& place, Time now) {
  std::deque<Waiting> later;
  while (!waiting_.empty()) {
    Waiting next = std::move(waiting_.front());
    waiting_.pop_front();
    if (must_wait(next, place.frames, now)) {
      later.push_back(std::move(next));
      continue;
    }
    const auto at = placed(next.detection, place);
    const bool frames_come = first_ && now - *first_ < kFramesCome;
    if (!at && at.reason() == Reason::frame_unknown && frames_come) {
      later.push_back(std::move(next));
      continue;
    }
    const auto taken = at ? reporter_.take(next.detection, *at, next.message, now) : Result<void>(at.error());
    if (!taken) refuse(next.topic, taken.error());
  }
  waiting_ = std::move(later);
}

Result<Pose3> DetectionInput::pose_at(const Detection& detection, const Frames& frames) const {
  if (!frames.initialised())
    return Error{Reason::driver_silent, "there is no odometry to place objects with"};
  if (detection.stamp == 0) return wrong_stamp(detection, 0.0);
  const std::uint64_t newest = frames.newest_stamp();
  if (newest == 0) return frames.T_odom_base();  // The odometry has no stamps.
  const auto pose = frames.T_odom_base_at(detection.stamp);
  if (!pose) return wrong_stamp(detection, signed_seconds(detection.stamp, newest));
  return pose;
}

Result<Eigen::Vector3d> DetectionInput::placed(const Detection& detection, const RobotPlace& place) const {
  // Also of an object whose place does not depend on the pose: one of long ago may be gone.
  const auto T_odom_base = pose_at(detection, place.frames);
  if (!T_odom_base) return T_odom_base.error();
  if (detection.frame == "map") return detection.position;
  if (place.unknown != Reason::none)
    return Error{place.unknown, "the robot does not know where it is, so objects have no place in the map"};
  if (detection.frame == "odom") return place.frames.to_map(place.T_odom_driver * detection.position);
  const auto T_base_frame = mounting(detection.frame);
  if (!T_base_frame) return T_base_frame.error();
  return place.frames.to_map(*T_odom_base * (*T_base_frame * detection.position));
}

Result<Pose3> DetectionInput::mounting(const std::string& frame) const {
  if (frame == "base_link") return Pose3{};
  for (const LidarConfig& lidar : platform_.all_lidars())
    if (lidar.frame == frame) return lidar.mounting.pose();
  if (platform_.imu && platform_.imu->frame == frame) return platform_.imu->mounting.pose();
  perception::FrameTree tree;
  for (const StaticFrames::Frame& each : static_frames_->all())
    (void)tree.set(each.parent, each.child, each.T_parent_child);  // The sensors component reports bad ones.
  if (auto T_base_frame = tree.find("base_link", frame)) return T_base_frame;
  return Error{Reason::frame_unknown,
               "the frame '" + shown(frame) +
                   "' of objects is neither base_link, odom, map, nor in `sensors` of the "
                   "platform's file, nor in tf_static"};
}

void DetectionInput::refuse(const std::string& topic, const Error& why) {
  const std::uint64_t count = ++refused_[topic];
  outputs_.fault(
      {topic,
       "sensor_refused",
       Severity::warning,
       {why.reason, "/" + topic + ": " + why.text + " (" + std::to_string(count) + " refused so far)"}});
}

void DetectionInput::look(const wire::Participant& wire) {
  std::map<std::string, std::uint64_t> malformed;
  for (const wire::TopicCount& count : wire.counters().topics)
    for (std::size_t n = 0; n < names_.size(); ++n)
      if (count.topic == names_[n]) malformed[params_.topics[n]] += count.malformed;
  for (const auto& [topic, count] : malformed)
    for (std::uint64_t more = count - std::min(malformed_[topic], count); more > 0; more = 0) {
      refused_[topic] += more - 1;
      refuse(topic,
             {Reason::malformed, "a message is no vision_msgs/msg/Detection3DArray, or has more than " +
                                     std::to_string(wire::topics::kDetections.max_bytes / 1024) + " kB"});
    }
  malformed_ = std::move(malformed);
}

std::uint64_t DetectionInput::refused() const {
  std::uint64_t sum = 0;
  for (const auto& [topic, count] : refused_) sum += count;
  return sum;
}

}  // namespace adit::agent
