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
#include "sensor_msgs/msg/Imu.h"
#include "sensor_msgs/msg/LaserScan.h"
#include "sensor_msgs/msg/PointCloud2.h"
#include "tf2_msgs/msg/TFMessage.h"

namespace adit::agent {

/// Readers of all sensors of a platform.
struct SensorReaders {
  std::deque<std::string> names{};  ///< Topics that the platform's file names.
  std::vector<std::unique_ptr<wire::RawReader>> readers{};
};

/// Opens readers of the sensors of `platform`, of /scan, /odom and /tf_static.
///
/// @param taker  Returns a pointer to what takes the samples now, or null; it is called on the strand of `io`
///     and has take(cloud, index of the lidar, received) and take(sample, received) for the other messages.
/// Errors of the wire.
template <class Taker>
Result<SensorReaders> read_sensors(const wire::ComponentIo& io, const Platform& platform, Taker taker) {
  SensorReaders all{};
  const auto open = [&](auto topic, const std::string& named, auto take) -> Result<void> {
    if (!named.empty()) topic.name = all.names.emplace_back("rt/" + named).c_str();
    return io.open(all.readers.emplace_back(), topic,
                   [taker, take](const auto& sample, const wire::SampleInfo& info) {
                     if (auto* now = taker()) take(*now, sample, info.received);
                   });
  };
  namespace topics = wire::topics;
  const std::vector<LidarConfig> lidars = platform.all_lidars();
  for (std::size_t n = 0; n < lidars.size(); ++n)
    if (auto opened = open(topics::kPoints, lidars[n].topic,
                           [n](auto& t, const auto& cloud, Time received) { t.take(cloud, n, received); });
        !opened)
      return opened.error();
  const auto plain = [](auto& t, const auto& sample, Time received) { t.take(sample, received); };
  if (auto opened = open(topics::kScan, "", plain); !opened) return opened.error();
  if (auto opened = open(topics::kOdom, "", plain); !opened) return opened.error();
  if (auto opened = open(topics::kTfStatic, "", plain); !opened) return opened.error();
  if (platform.imu)
    if (auto opened = open(topics::kImu, platform.imu->topic, plain); !opened) return opened.error();
  return all;
}

}  // namespace adit::agent
