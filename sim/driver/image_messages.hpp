// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "sim/world/camera.hpp"

namespace std_msgs::msg {
class Header;
}

namespace adit::sim {

/// A serialised sensor_msgs/Image, rgb8.
std::vector<std::uint8_t> image_message(const CameraImage& image, const std_msgs::msg::Header& header);
/// A serialised sensor_msgs/CompressedImage with a JPEG, in the format that ROS's image_transport names.
/// `broken`: only the first half of the JPEG is there.
std::vector<std::uint8_t> jpeg_message(const CameraImage& image, bool broken,
                                       const std_msgs::msg::Header& header);

}  // namespace adit::sim
