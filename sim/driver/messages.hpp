// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/geometry/pose.hpp"
#include "core/time/time.hpp"
#include "sensor_msgs/msg/Imu.h"
#include "sim/world/imu.hpp"
#include "sim/world/odometry.hpp"
#include "sim/world/sweep.hpp"

namespace nav_msgs::msg {
class Odometry;
}

namespace adit::sim {

std_msgs::msg::Header message_header(Time stamp, const std::string& frame);

/// A serialised PointCloud2 with float32 x, y and z.
std::vector<std::uint8_t> cloud_message(const PointCloud& points, const std_msgs::msg::Header& header);
/// The same with intensity and t (float32; t in seconds since the stamp) and ring (uint16).
std::vector<std::uint8_t> cloud_message(std::span<const SweepPoint> points,
                                        const std_msgs::msg::Header& header);

/// Without orientation, which its covariance says (-1).
sensor_msgs::msg::Imu imu_message(const ImuSample& sample, const ImuParams& params,
                                  const std_msgs::msg::Header& header);

/// Fills in the covariances of pose and twist.
void set_covariance(nav_msgs::msg::Odometry& odom, const OdometrySigma& sigma);

}  // namespace adit::sim
