// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include "perception/camera/area_scaler.hpp"
#include "perception/camera/picture.hpp"

namespace adit::perception {
namespace {

enum class Layout : std::uint8_t {
  packed,  ///< Red, green and blue are at the bytes `order` of a pixel.
  grey,    ///< One byte.
  grey16,  ///< Two bytes, of which the higher one is used.
  yuv422,  ///< Two pixels share u and v; order: first y, u, v of four bytes.
  yuv420,  ///< A plane of y, and below it one of pairs of u and v for four pixels each; order: -, u, v.
  mosaic,  ///< Bayer pattern; order: red, one green, blue of the four pixels of a cell.
};

struct Encoding {
  std::string_view name{};
  Layout layout{};
  std::uint32_t pixel_bytes{};  ///< Of a row, for each pixel.
  std::array<std::uint8_t, 3> order{};
};

// Names as in sensor_msgs/image_encodings.hpp; yuv422 and yuv422_yuy2 are its older names of uyvy and yuyv.
constexpr std::array kEncodings{
    Encoding{"rgb8", Layout::packed, 3, {0, 1, 2}},
    Encoding{"bgr8", Layout::packed, 3, {2, 1, 0}},
    Encoding{"rgba8", Layout::packed, 4, {0, 1, 2}},
    Encoding{"bgra8", Layout::packed, 4, {2, 1, 0}},
    Encoding{"8UC3", Layout::packed, 3, {2, 1, 0}},
    Encoding{"8UC4", Layout::packed, 4, {2, 1, 0}},
    Encoding{"mono8", Layout::grey, 1, {}},
    Encoding{"8UC1", Layout::grey, 1, {}},
    Encoding{"mono16", Layout::grey16, 2, {}},
    Encoding{"yuv422", Layout::yuv422, 2, {1, 0, 2}},
    Encoding{"uyvy", Layout::yuv422, 2, {1, 0, 2}},
    Encoding{"yuv422_yuy2", Layout::yuv422, 2, {0, 1, 3}},
    Encoding{"yuyv", Layout::yuv422, 2, {0, 1, 3}},
    Encoding{"nv12", Layout::yuv420, 1, {0, 0, 1}},
    Encoding{"nv21", Layout::yuv420, 1, {0, 1, 0}},
    Encoding{"bayer_rggb8", Layout::mosaic, 1, {0, 1, 3}},
    Encoding{"bayer_bggr8", Layout::mosaic, 1, {3, 1, 0}},
    Encoding{"bayer_gbrg8", Layout::mosaic, 1, {2, 0, 1}},
    Encoding{"bayer_grbg8", Layout::mosaic, 1, {1, 0, 2}},
};

/// YUV of video (BT.601, luma in [16, 235]), as OpenCV reads these encodings.
void put_yuv(std::uint8_t* rgb, int y, int u, int v) {
  const int luma = 298 * (y - 16) + 128;
  const auto byte = [](int value) { return static_cast<std::uint8_t>(std::clamp(value >> 8, 0, 255)); };
  u -= 128;
  v -= 128;
  rgb[0] = byte(luma + 409 * v);
  rgb[1] = byte(luma - 100 * u - 208 * v);
  rgb[2] = byte(luma + 516 * u);
}

void read_packed(const Encoding& encoding, const std::uint8_t* from, std::uint32_t width, std::uint8_t* rgb) {
  const auto [red, green, blue] = encoding.order;
  for (const std::uint8_t* end = rgb + std::size_t{3} * width; rgb != end;
       rgb += 3, from += encoding.pixel_bytes) {
    rgb[0] = from[red];
    rgb[1] = from[green];
    rgb[2] = from[blue];
  }
}

void read_yuv422(const Encoding& encoding, const std::uint8_t* from, std::uint32_t width, std::uint8_t* rgb) {
  const auto [y, u, v] = encoding.order;
  for (std::uint32_t x = 0; x < width; x += 2, from += 4, rgb += 6) {
    put_yuv(rgb, from[y], from[u], from[v]);
    put_yuv(rgb + 3, from[y + 2], from[u], from[v]);
  }
}

void read_yuv420(const Encoding& encoding, const std::uint8_t* luma, const std::uint8_t* colour,
                 std::uint32_t width, std::uint8_t* rgb) {
  for (std::uint32_t x = 0; x < width; ++x, rgb += 3) {
    const std::uint8_t* pair = colour + (x & ~1U);
    put_yuv(rgb, luma[x], pair[encoding.order[1]], pair[encoding.order[2]]);
  }
}

/// Each cell of two by two gives one pixel, of which green is the mean of two.
void read_mosaic(const Encoding& encoding, const std::uint8_t* upper, const std::uint8_t* lower,
                 std::uint32_t cells, std::uint8_t* rgb) {
  const auto [red, green, blue] = encoding.order;
  for (std::uint32_t x = 0; x < cells; ++x, upper += 2, lower += 2, rgb += 3) {
    const std::array<std::uint8_t, 4> cell{upper[0], upper[1], lower[0], lower[1]};
    rgb[0] = cell[red];
    rgb[1] = static_cast<std::uint8_t>((cell[green] + cell[3 - green] + 1) / 2);  // Greens are opposite.
    rgb[2] = cell[blue];
  }
}

/// Where the rows of a picture are, in `data` that was checked.
struct RawRows {
  const RawPicture& raw;
  const Encoding& encoding;
  std::vector<std::uint8_t> buffer{};

  const std::uint8_t* source(std::uint32_t y) const { return raw.data.data() + std::size_t{y} * raw.step; }
  /// Row of the picture that is scaled: grey or red, green, blue.
  const std::uint8_t* read(std::uint32_t y, std::uint32_t width) {
    if (encoding.layout == Layout::grey || encoding.name == "rgb8") return source(y);
    buffer.resize(std::size_t{3} * width);
    switch (encoding.layout) {
      case Layout::packed:
        read_packed(encoding, source(y), width, buffer.data());
        break;
      case Layout::grey16:
        for (std::uint32_t x = 0; x < width; ++x) buffer[x] = source(y)[2 * x + (raw.big_endian ? 0 : 1)];
        break;
      case Layout::yuv422:
        read_yuv422(encoding, source(y), width, buffer.data());
        break;
      case Layout::yuv420:
        read_yuv420(encoding, source(y), source(raw.height + y / 2), width, buffer.data());
        break;
      case Layout::mosaic:
        read_mosaic(encoding, source(2 * y), source(2 * y + 1), width, buffer.data());
        break;
      case Layout::grey:
        break;
    }
    return buffer.data();
  }
};

Error unknown_encoding(const std::string& name) {
  std::string text = "pictures of the encoding '" + name.substr(0, 40) + "' are not read, only:";
  for (const Encoding& encoding : kEncodings) text += " " + std::string(encoding.name);
  return {Reason::not_supported, text};
}

Error sizes_differ(const RawPicture& raw, const char* what) {
  return {Reason::malformed, "a picture of " + std::to_string(raw.width) + " x " +
                                 std::to_string(raw.height) + " pixels (" + raw.encoding + ") has " + what};
}

}  // namespace

Result<Picture> convert(const RawPicture& raw, std::uint32_t width, std::uint32_t height) {
  const auto encoding = std::ranges::find(kEncodings, std::string_view(raw.encoding), &Encoding::name);
  if (encoding == kEncodings.end()) return unknown_encoding(raw.encoding);
  if (width == 0 || height == 0) return {Reason::out_of_range, "a picture without pixels is asked for"};
  if (raw.width == 0 || raw.height == 0) return sizes_differ(raw, "a side of 0");
  if (raw.width > kMaxPictureSide || raw.height > kMaxPictureSide ||
      std::uint64_t{raw.width} * raw.height > kMaxPicturePixels)
    return {Reason::out_of_range, "a picture has more than " + std::to_string(kMaxPicturePixels / 1'000'000) +
                                      " million pixels, or a side of more than " +
                                      std::to_string(kMaxPictureSide)};
  const bool pairs = encoding->layout == Layout::yuv422 || encoding->layout == Layout::yuv420;
  if (pairs && raw.width % 2 != 0) return sizes_differ(raw, "an odd width");
  if (encoding->layout == Layout::yuv420 && raw.height % 2 != 0) return sizes_differ(raw, "an odd height");
  if (encoding->layout == Layout::mosaic && (raw.width < 2 || raw.height < 2))
    return sizes_differ(raw, "no whole cell of the pattern");
  const std::uint64_t row = std::uint64_t{raw.width} * encoding->pixel_bytes;
  if (raw.step < row) return sizes_differ(raw, "a step that is too short");
  const std::uint64_t rows = raw.height + (encoding->layout == Layout::yuv420 ? raw.height / 2 : 0U);
  // The last row may come without the bytes that fill up the step.
  if (raw.data.size() < raw.step * (rows - 1) + row) return sizes_differ(raw, "too few bytes");
  const bool halved = encoding->layout == Layout::mosaic;
  const PictureSize from{halved ? raw.width / 2 : raw.width, halved ? raw.height / 2 : raw.height};
  const bool grey = encoding->layout == Layout::grey || encoding->layout == Layout::grey16;
  AreaScaler scaler(from, fitted(from, {width, height}), grey ? 1 : 3);
  RawRows source{raw, *encoding, {}};
  for (std::uint32_t y = 0; y < from.height; ++y) scaler.add(source.read(y, from.width));
  return scaler.take();
}

}  // namespace adit::perception
