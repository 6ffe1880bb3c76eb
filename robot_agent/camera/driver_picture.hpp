// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "core/result/result.hpp"
#include "core/time/time.hpp"
#include "perception/camera/picture.hpp"

namespace sensor_msgs::msg {
class Image;
class CompressedImage;
}  // namespace sensor_msgs::msg

namespace adit::agent {

/// A picture as its driver sent it.
struct DriverPicture {
  bool jpeg{};                      ///< `bytes` are a JPEG; else pixels as `width` and those behind it say.
  std::uint32_t width{}, height{};  ///< Pixels; of a JPEG 0.
  std::uint32_t step{};             ///< Bytes of a row.
  std::string encoding{};           ///< As of sensor_msgs/Image.
  bool big_endian{};
  std::vector<std::uint8_t> bytes{};
  std::uint64_t stamp{};  ///< By the driver's clock, ns; 0: none.
  Time received{};
};

DriverPicture picture_of(const sensor_msgs::msg::Image& message, Time received);
DriverPicture picture_of(const sensor_msgs::msg::CompressedImage& message, Time received);

/// The pixels, scaled down to fit into width x height. Errors: as of perception::convert() and decode_jpeg().
Result<perception::Picture> pixels_of(const DriverPicture& picture, std::uint32_t width,
                                      std::uint32_t height);

/// A JPEG of at most transfer::ShotPiece::kMaxPicture bytes: the driver's own if it is small enough and
/// sound, else one of at most 1600 pixels. Errors: as of pixels_of().
Result<std::vector<std::uint8_t>> jpeg_of(const DriverPicture& picture);

}  // namespace adit::agent
