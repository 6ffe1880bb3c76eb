// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/camera/driver_picture.hpp"

#include "core/transfer/shot_piece.hpp"
#include "robot_agent/motion/sensor_messages.hpp"
#include "sensor_msgs/msg/CompressedImage.h"
#include "sensor_msgs/msg/Image.h"

namespace adit::agent {
namespace {

constexpr std::uint32_t kShotWidth = 1600, kShotHeight = 1200;  // Pixels.

}  // namespace

DriverPicture picture_of(const sensor_msgs::msg::Image& message, Time received) {
  return {.width = message.width(),
          .height = message.height(),
          .step = message.step(),
          .encoding = message.encoding(),
          .big_endian = message.is_bigendian() != 0,
          .bytes = message.data(),
          .stamp = nanoseconds_of(message.header()),
          .received = received};
}

DriverPicture picture_of(const sensor_msgs::msg::CompressedImage& message, Time received) {
  return {.jpeg = true,
          .encoding = message.format(),
          .bytes = message.data(),
          .stamp = nanoseconds_of(message.header()),
          .received = received};
}

Result<perception::Picture> pixels_of(const DriverPicture& picture, std::uint32_t width,
                                      std::uint32_t height) {
  if (picture.jpeg) return perception::decode_jpeg(picture.bytes, width, height);
  return perception::convert({.width = picture.width,
                              .height = picture.height,
                              .step = picture.step,
                              .encoding = picture.encoding,
                              .big_endian = picture.big_endian,
                              .data = picture.bytes},
                             width, height);
}

Result<std::vector<std::uint8_t>> jpeg_of(const DriverPicture& picture) {
  const auto pixels = pixels_of(picture, kShotWidth, kShotHeight);
  if (!pixels) return pixels.error();
  constexpr std::size_t kMost = transfer::ShotPiece::kMaxPicture;
  if (picture.jpeg && picture.bytes.size() <= kMost) return picture.bytes;
  std::vector<std::uint8_t> out;
  for (int quality = 90; quality >= 30; quality -= 20) {
    out = perception::encode_jpeg(*pixels, quality);
    if (out.size() <= kMost) return out;
  }
  return Error{Reason::out_of_range, "a picture that needs more than 512 kB even at a low quality"};
}

}  // namespace adit::agent
