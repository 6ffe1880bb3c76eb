// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/findings/object_placer.hpp"

#include <array>
#include <cstdio>

#include "perception/input/frame_tree.hpp"
#include "robot_agent/findings/detection_messages.hpp"

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

bool ObjectPlacer::must_wait(const Detection& detection, Time received, const Frames& frames, Time now) {
  if (now - received >= kPatience) return false;
  if (!frames.initialised()) return true;
  const std::uint64_t newest = frames.newest_stamp(), stamp = detection.stamp;
  return newest != 0 && stamp > newest && stamp - newest <= kAhead;
}

Result<Pose3> ObjectPlacer::pose_at(const Detection& detection, const Frames& frames) {
  if (!frames.initialised())
    return Error{Reason::driver_silent, "there is no odometry to place objects with"};
  if (detection.stamp == 0) return wrong_stamp(detection, 0.0);
  const std::uint64_t newest = frames.newest_stamp();
  if (newest == 0) return frames.T_odom_base();  // The odometry has no stamps.
  const auto pose = frames.T_odom_base_at(detection.stamp);
  if (!pose) return wrong_stamp(detection, signed_seconds(detection.stamp, newest));
  return pose;
}

Result<Eigen::Vector3d> ObjectPlacer::placed(const Detection& detection, const RobotPlace& place) const {
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

Result<Pose3> ObjectPlacer::mounting(const std::string& frame) const {
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

}  // namespace adit::agent
