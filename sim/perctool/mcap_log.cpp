// SPDX-License-Identifier: Apache-2.0
#include <fstream>

#include "core/record/mcap_reader.hpp"
#include "core/wire/topics.hpp"
#include "core/wire/typed.hpp"
#include "nav_msgs/msg/Odometry.h"
#include "robot_agent/motion/scans.hpp"
#include "sensor_msgs/msg/Imu.h"
#include "sensor_msgs/msg/PointCloud2.h"
#include "sim/perctool/recorded_topics.hpp"
#include "sim/perctool/sensor_log.hpp"

namespace adit::sim::perctool {
namespace {

template <class Header>
std::uint64_t stamp_ns(const Header& header) {
  return static_cast<std::uint64_t>(header.stamp().sec()) * 1'000'000'000U + header.stamp().nanosec();
}

Pose3 pose_of(const nav_msgs::msg::Odometry& odometry) {
  const auto& p = odometry.pose().pose().position();
  const auto& q = odometry.pose().pose().orientation();
  const Eigen::Quaterniond turn(q.w(), q.x(), q.y(), q.z());
  const bool usable = turn.norm() > 0.5 && turn.norm() < 2.0;
  return {{p.x(), p.y(), p.z()}, usable ? turn.normalized() : Eigen::Quaterniond::Identity()};
}

/// Hands the messages of a file on; remembers the first error.
class Player {
 public:
  Player(std::string file, SensorSink& sink) : file_(std::move(file)), sink_(sink) {}

  void take(const record::Channel& channel, const record::Message& message) {
    if (!state_) return;
    const std::string& topic = channel.topic;
    if (topic == wire::topics::kImu.name) state_ = imu(message);
    if (topic == wire::topics::kOdom.name || topic == kTruthTopic)
      state_ = pose(message, topic == kTruthTopic);
    if (topic == wire::topics::kPoints.name) state_ = points(message);
  }
  const Result<void>& state() const { return state_; }

 private:
  Error malformed(const char* what) const {
    return {Reason::malformed, file_ + ": a message of " + what + " does not fit its type"};
  }
  Result<void> imu(const record::Message& message) {
    sensor_msgs::msg::Imu imu;
    if (!wire::decode(message.data, imu)) return malformed("the IMU");
    const auto &w = imu.angular_velocity(), &a = imu.linear_acceleration();
    sink_.on_imu({stamp_ns(imu.header()), {w.x(), w.y(), w.z()}, {a.x(), a.y(), a.z()}});
    return {};
  }
  Result<void> pose(const record::Message& message, bool truth) {
    nav_msgs::msg::Odometry odometry;
    if (!wire::decode(message.data, odometry)) return malformed("the odometry");
    const std::uint64_t stamp = stamp_ns(odometry.header());
    if (truth)
      sink_.on_truth({static_cast<double>(stamp) * 1e-9, pose_of(odometry)});
    else
      sink_.on_wheels({stamp, pose_of(odometry)});
    return {};
  }
  Result<void> points(const record::Message& message) {
    sensor_msgs::msg::PointCloud2 cloud;
    if (!wire::decode(message.data, cloud)) return malformed("the lidar");
    auto sweep = agent::to_sweep(cloud, kCloudPeriod);
    if (!sweep) return Error{sweep.error().reason, file_ + ": " + sweep.error().text};
    return sink_.on_sweep(std::move(*sweep));
  }

  std::string file_;
  SensorSink& sink_;
  Result<void> state_{};
};

}  // namespace

Result<void> play_mcap(const std::string& file, SensorSink& sink) {
  std::ifstream in(file, std::ios::binary);
  if (!in) return {Reason::cannot_read, file + ": cannot be read"};
  Player player(file, sink);
  record::Visitor visitor;
  visitor.message = [&player](const record::Channel& channel, const record::Message& message) {
    player.take(channel, message);
  };
  const auto report = record::read_mcap(in, visitor);
  if (!report) return Error{report.error().reason, file + ": " + report.error().text};
  return player.state();
}

Result<std::string> recorded_sensors(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) return {Reason::cannot_read, file + ": cannot be read"};
  std::string text;
  record::Visitor visitor;
  visitor.metadata = [&text](const std::string& name, const record::Text& entries) {
    if (name != kAboutRecording) return;
    for (const auto& [key, value] : entries)
      if (key == "sensors") text = value;
  };
  const auto report = record::read_mcap(in, visitor);
  if (!report) return Error{report.error().reason, file + ": " + report.error().text};
  return text;
}

}  // namespace adit::sim::perctool
