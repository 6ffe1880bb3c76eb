// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/result/result.hpp"

namespace adit::perception {

/// Pixels of a picture, row by row without a gap.
struct Picture {
  std::uint32_t width{}, height{};
  std::uint8_t channels{1};           ///< 1: grey; 3: red, green, blue.
  std::vector<std::uint8_t> bytes{};  ///< Size: width x height x channels.
};

/// A picture as a driver sends it (sensor_msgs/Image); `data` is not copied.
struct RawPicture {
  std::uint32_t width{}, height{};
  std::uint32_t step{};    ///< Bytes of a row.
  std::string encoding{};  ///< As of sensor_msgs: rgb8, bgr8, rgba8, bgra8, mono8, mono16, yuv422...
  bool big_endian{};
  std::span<const std::uint8_t> data{};
};

inline constexpr std::uint32_t kMaxPictureSide = 10'000;        ///< Of a picture that is read, pixels.
inline constexpr std::uint64_t kMaxPicturePixels = 40'000'000;  ///< The same.
inline constexpr int kMaxJpegScans = 32;  ///< Of a progressive JPEG that is read; cameras write 10.

/// Converts a picture, scaled down by averaging so that it fits into width x height with the ratio of its
/// sides unchanged; a smaller one keeps its size. Reads the input once. Four pixels of a Bayer pattern give
/// one.
///
/// Errors: not_supported (the encoding; the text lists those that are), malformed (sizes, step and data do
/// not fit), out_of_range (beyond the bounds above, or a width or height of 0 is asked for).
Result<Picture> convert(const RawPicture& raw, std::uint32_t width, std::uint32_t height);

/// Decodes a JPEG and scales it like convert(). A grey JPEG gives a grey picture. Damage that the decoder
/// warns of is an error. Errors: malformed, out_of_range, not_supported (CMYK; also other formats such as
/// PNG, which the text names).
Result<Picture> decode_jpeg(std::span<const std::uint8_t> jpeg, std::uint32_t width, std::uint32_t height);

/// Decodes a JPEG that jpeg_of() composed. A damaged stripe spoils its own pixels and no others: the next
/// restart marker synchronises the decoder, and colours are not interpolated across stripes. Errors as of
/// decode_jpeg().
Result<Picture> decode_jpeg_tolerant(std::span<const std::uint8_t> jpeg, std::uint32_t width,
                                     std::uint32_t height);

/// Encodes a picture as a JPEG that others can read; colour is stored at half resolution. `quality`: [1,
/// 100]. Empty when the size and the bytes of the picture do not fit.
std::vector<std::uint8_t> encode_jpeg(const Picture& picture, int quality);

}  // namespace adit::perception
