// SPDX-License-Identifier: Apache-2.0
#include "sim/driver/image_messages.hpp"

#include "core/wire/typed.hpp"
#include "sensor_msgs/msg/CompressedImage.h"
#include "sensor_msgs/msg/Image.h"
#include "sim/driver/jpeg.hpp"

namespace adit::sim {
namespace {

constexpr int kJpegQuality = 80;  // As image_transport's usual setting.

}  // namespace

std::vector<std::uint8_t> image_message(const CameraImage& image, const std_msgs::msg::Header& header) {
  sensor_msgs::msg::Image message;
  message.header(header);
  message.width(static_cast<std::uint32_t>(image.width));
  message.height(static_cast<std::uint32_t>(image.height));
  message.encoding("rgb8");
  message.is_bigendian(0);
  message.step(3 * message.width());
  message.data() = image.rgb;
  std::vector<std::uint8_t> out;
  wire::encode(message, out);
  return out;
}

std::vector<std::uint8_t> jpeg_message(const CameraImage& image, bool broken,
                                       const std_msgs::msg::Header& header) {
  sensor_msgs::msg::CompressedImage message;
  message.header(header);
  message.format("rgb8; jpeg compressed bgr8");
  message.data() = encode_jpeg({image.width, image.height, 3, image.rgb}, kJpegQuality);
  if (broken) message.data().resize(message.data().size() / 2);
  std::vector<std::uint8_t> out;
  wire::encode(message, out);
  return out;
}

}  // namespace adit::sim
