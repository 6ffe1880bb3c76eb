// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstring>
#include <span>
#include <string>

#include "sensor_msgs/msg/PointCloud2.h"

namespace adit {

/// A cloud as lidar drivers publish it: `values` float32 for each point, x, y and z first, `values` at
/// least 3.
inline sensor_msgs::msg::PointCloud2 cloud_of(std::span<const float> numbers, std::uint32_t values = 3) {
  sensor_msgs::msg::PointCloud2 cloud;
  for (std::uint32_t i = 0; i < 3; ++i) {
    sensor_msgs::msg::PointField field;
    field.name(std::string(1, "xyz"[i]));
    field.offset(4 * i);
    field.datatype(7);  // float32
    field.count(1);
    cloud.fields().push_back(field);
  }
  cloud.height(1);
  cloud.width(static_cast<std::uint32_t>(numbers.size()) / values);
  cloud.point_step(4 * values);
  cloud.row_step(cloud.point_step() * cloud.width());
  cloud.data().resize(numbers.size_bytes());
  if (!numbers.empty()) std::memcpy(cloud.data().data(), numbers.data(), numbers.size_bytes());
  return cloud;
}

}  // namespace adit
