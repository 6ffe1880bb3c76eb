// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "core/config/platform.hpp"
#include "core/wire/component_io.hpp"
#include "core/wire/topics.hpp"
#include "nav_msgs/msg/Odometry.h"
#include "robot_agent/motion/one_source.hpp"
#include "robot_agent/motion/sensor_messages.hpp"
#include "robot_agent/motion/static_frames.hpp"
#include "sensor_msgs/msg/Imu.h"
#include "sensor_msgs/msg/LaserScan.h"
#include "sensor_msgs/msg/PointCloud2.h"
#include "tf2_msgs/msg/TFMessage.h"

namespace adit::agent {

/// The frames of a message.
inline std::vector<StaticFrames::Frame> frames_of(const tf2_msgs::msg::TFMessage& message) {
  std::vector<StaticFrames::Frame> out;
  for (const auto& each : message.transforms())
    out.push_back({each.header().frame_id(),
                   each.child_frame_id(),
                   {vector_of(each.transform().translation()), quaternion_of(each.transform().rotation())}});
  return out;
}

/// Readers of all sensors of a platform.
struct SensorReaders {
  std::deque<std::string> names{};  ///< Topics that the platform's file names.
  std::vector<std::unique_ptr<wire::RawReader>> readers{};
};

/// Opens readers of the sensors of `platform`, of /scan, /odom and /tf_static. Of each topic but the last one
/// only one participant is heard.
///
/// @param taker  Returns a pointer to what takes the samples now, or null; it is called on the strand of `io`
///     and has take(cloud, index of the lidar, received) and take(sample, received) for the other messages,
///     and two_sources(topic, source).
/// @param odometry  The source of the odometry, shared with its other readers.
/// @param frames  Keeps the frames of /tf_static, also while there is no taker; null: they are not kept.
/// Errors of the wire.
template <class Taker>
Result<SensorReaders> read_sensors(const wire::ComponentIo& io, const Platform& platform, Taker taker,
                                   std::shared_ptr<OneSource> odometry,
                                   std::shared_ptr<StaticFrames> frames = nullptr) {
  SensorReaders all{};
  const auto open = [&](auto topic, const std::string& named, std::shared_ptr<OneSource> source,
                        auto take) -> Result<void> {
    const std::string& name = all.names.emplace_back(named.empty() ? topic.name : "rt/" + named);
    topic.name = name.c_str();
    return io.open(all.readers.emplace_back(), topic,
                   [taker, take, source, frames, short_name = name.substr(3)](const auto& sample,
                                                                              const wire::SampleInfo& info) {
                     if constexpr (std::is_same_v<std::decay_t<decltype(sample)>, tf2_msgs::msg::TFMessage>)
                       if (frames)
                         for (const StaticFrames::Frame& frame : frames_of(sample)) frames->keep(frame);
                     auto* now = taker();
                     if (!now) return;
                     const auto use = source ? source->take(info.sender, info.received) : OneSource::Use::yes;
                     if (use == OneSource::Use::besides) now->two_sources(short_name, *source);
                     if (use != OneSource::Use::no) take(*now, sample, info.received);
                   });
  };
  namespace topics = wire::topics;
  const std::vector<LidarConfig> lidars = platform.all_lidars();
  const auto one = [] { return std::make_shared<OneSource>(); };
  for (std::size_t n = 0; n < lidars.size(); ++n)
    if (auto opened = open(topics::kPoints, lidars[n].topic, one(),
                           [n](auto& t, const auto& cloud, Time received) { t.take(cloud, n, received); });
        !opened)
      return opened.error();
  const auto plain = [](auto& t, const auto& sample, Time received) { t.take(sample, received); };
  if (auto opened = open(topics::kScan, "", one(), plain); !opened) return opened.error();
  if (auto opened = open(topics::kOdom, "", std::move(odometry), plain); !opened) return opened.error();
  if (auto opened = open(topics::kTfStatic, "", nullptr, plain); !opened) return opened.error();
  if (platform.imu)
    if (auto opened = open(topics::kImu, platform.imu->topic, one(), plain); !opened) return opened.error();
  return all;
}

}  // namespace adit::agent
