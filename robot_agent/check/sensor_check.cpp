// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/check/sensor_check.hpp"

#include <algorithm>
#include <cmath>

#include "robot_agent/motion/scans.hpp"
#include "robot_agent/motion/sensor_messages.hpp"

namespace adit::agent {
namespace {

constexpr std::size_t kMaxFrames = 8;
constexpr double kTurns = 0.2;  ///< Slower turns say nothing about the axis of the gyro, rad/s.

}  // namespace

SensorCheck::SensorCheck(const Platform& platform, ConfigLines lines)
    : platform_(platform), lines_(std::move(lines)), input_(platform) {
  for (const LidarConfig& config : platform.all_lidars()) lidars_.emplace_back().config = config;
}

void SensorCheck::Stream::note(std::uint64_t stamp, const std::string& frame, Time received) {
  const double delay = seconds(received.time_since_epoch()) - static_cast<double>(stamp) * 1e-9;
  least_delay = count == 0 ? delay : std::min(least_delay, delay);
  most_delay = count == 0 ? delay : std::max(most_delay, delay);
  if (count == 0) first = received;
  last = received;
  ++count;
  if (frames.size() < kMaxFrames || frames.contains(frame)) ++frames[frame];
}

double SensorCheck::Stream::rate() const {
  const double span = seconds(last - first);
  return count > 1 && span > 0 ? static_cast<double>(count - 1) / span : 0.0;
}

void SensorCheck::take(const sensor_msgs::msg::PointCloud2& cloud, std::size_t lidar, Time received) {
  if (lidar >= lidars_.size()) return;
  Lidar& taken = lidars_[lidar];
  taken.stream.note(nanoseconds_of(cloud.header()), cloud.header().frame_id(), received);
  take(to_sweep(cloud, 1.0 / taken.config.rate), taken, cloud.header().frame_id());
}

void SensorCheck::take(const sensor_msgs::msg::LaserScan& scan, Time received) {
  Lidar& taken = lidars_.front();
  taken.planar = true;
  taken.stream.note(nanoseconds_of(scan.header()), scan.header().frame_id(), received);
  take(to_sweep(scan, 0.0, 1.0 / taken.config.rate), taken, scan.header().frame_id());
}

void SensorCheck::take(const Result<perception::Sweep>& sweep, Lidar& lidar, const std::string& frame) {
  const auto unusable = [&lidar](const std::string& why) {
    ++lidar.stream.unusable;
    lidar.stream.error = why;
  };
  if (!sweep) return unusable(sweep.error().text);
  const auto T_base_lidar = input_.find(frame);
  if (!T_base_lidar) return;  // The line of the frames says so.
  std::size_t returns = 0;
  for (const perception::TimedPoint& point : sweep->points) {
    const float range = point.position.norm();
    const bool measured = range >= static_cast<float>(lidar.config.min_range) &&
                          range <= static_cast<float>(lidar.config.max_range);
    if (!measured) continue;  // Also what is not a number.
    ++returns;
    if (!turning_) lidar.ground.add((*T_base_lidar * point.position.cast<double>()).cast<float>());
  }
  if (returns == 0 && !lidar.planar) unusable("none of its points is a return");
}

void SensorCheck::take(const sensor_msgs::msg::Imu& imu, Time received) {
  if (!platform_.imu) return;
  const perception::ImuSample sample = imu_sample_of(imu);
  const std::string& frame = imu.header().frame_id();
  imu_.note(sample.stamp, frame, received);
  if (sample.stamp == 0 || !sample.gyro.allFinite() || !sample.accel.allFinite()) {
    ++imu_.unusable;
    imu_.error = sample.stamp == 0 ? "they have no stamp" : "a sample is no number";
    return;
  }
  const auto T_base_imu = input_.mounting_of_imu(frame);
  if (!T_base_imu) return;
  const Eigen::Vector3d rate = T_base_imu->orientation * sample.gyro;
  if (!turning_) {
    force_ += T_base_imu->orientation * sample.accel;
    gyro_ += rate;
    ++standing_;
    return;
  }
  turns_.add_rate(sample.stamp, rate.z());
  if (rate.norm() < kTurns) return;
  about_z_ += std::fabs(rate.z());
  about_all_ += rate.norm();
}

void SensorCheck::take(const nav_msgs::msg::Odometry& odometry, Time received) {
  const std::uint64_t stamp = nanoseconds_of(odometry.header());
  odometry_.note(stamp, odometry.header().frame_id(), received);
  const Eigen::Quaterniond q = quaternion_of(odometry.pose().pose().orientation());
  if (!is_rotation(q) || stamp == 0) {
    ++odometry_.unusable;
    odometry_.error = stamp == 0 ? "they have no stamp" : "its orientation is no quaternion";
    return;
  }
  if (turning_) turns_.add_yaw(stamp, Pose3{{0, 0, 0}, q.normalized()}.yaw());
}

void SensorCheck::take(const tf2_msgs::msg::TFMessage& transforms, Time) {
  for (const StaticFrames::Frame& frame : frames_of(transforms))
    (void)input_.add_transform(frame.parent, frame.child, frame.T_parent_child);
}

void SensorCheck::take(const sensor_msgs::msg::BatteryState& battery, const wire::ParticipantId& sender) {
  const auto charge = charge_.take(battery.percentage(), sender);
  if (battery_ && !battery_->ok) return;
  const std::string found = !charge       ? charge.error().text
                            : *charge < 0 ? "not measured, by the driver"
                                          : std::to_string(std::lround(*charge * 100)) + " %";
  battery_ = CheckLine{charge.ok(), "battery /battery_state: charge", found, ""};
}

void SensorCheck::two_sources(const std::string& topic, const OneSource& source) {
  two_sources_[topic] = {false, "/" + topic + ": source", agent::two_sources(topic, source).cause.text, ""};
}

void SensorCheck::look(const wire::Participant& wire, VelocityType velocity) {
  topics_.clear();
  const auto used = used_topics(platform_, velocity);
  bool velocities = false;
  for (const InputFault& clash : type_clashes(wire, used)) {
    topics_.push_back({false, "/" + clash.topic + ": type", clash.cause.text, ""});
    velocities = velocities || clash.topic == "cmd_vel";
  }
  if (velocities) return;
  // An agent reads what it writes, to notice others.
  const auto all = wire.endpoints(wire::topics::kCmdVel.name);
  const auto writes = [&](const wire::ParticipantId& participant) {
    return std::any_of(all.begin(), all.end(), [&](const wire::RemoteEndpoint& endpoint) {
      return endpoint.writes && endpoint.participant == participant;
    });
  };
  const auto readers = std::count_if(all.begin(), all.end(), [&](const wire::RemoteEndpoint& endpoint) {
    return !endpoint.writes && !writes(endpoint.participant);
  });
  topics_.push_back({readers > 0, "/cmd_vel: reader",
                     readers > 0 ? "the driver reads it"
                                 : "nobody reads it; is the driver running, on this topic and domain?",
                     ""});
}

}  // namespace adit::agent
