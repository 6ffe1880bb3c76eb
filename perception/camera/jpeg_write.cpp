// SPDX-License-Identifier: Apache-2.0
#include "perception/camera/jpeg_write.hpp"

#include <algorithm>
#include <cstdlib>
#include <cstring>

#include "perception/camera/jpeg_errors.hpp"

namespace adit::perception {
namespace {

/// An encoder and its output, freed with their owner.
struct JpegWriter {
  JpegWriter() { encoder.err = jump.install(); }
  ~JpegWriter() {
    jpeg_destroy_compress(&encoder);
    std::free(buffer);
  }
  JpegWriter(const JpegWriter&) = delete;
  JpegWriter& operator=(const JpegWriter&) = delete;

  jpeg_compress_struct encoder{};
  JpegJump jump{};
  unsigned char* buffer{};
  unsigned long size{};
};

/// `span`: of MCUs between restart markers; 0: there are none, and the tables are optimised.
bool write_rows(JpegWriter& writer, const Picture& picture, int quality, std::uint32_t span) {
  if (setjmp(writer.jump.target) != 0) return false;
  jpeg_compress_struct& encoder = writer.encoder;
  jpeg_create_compress(&encoder);
  jpeg_mem_dest(&encoder, &writer.buffer, &writer.size);
  encoder.image_width = picture.width;
  encoder.image_height = picture.height;
  encoder.input_components = picture.channels;
  encoder.in_color_space = picture.channels == 3 ? JCS_RGB : JCS_GRAYSCALE;
  jpeg_set_defaults(&encoder);
  jpeg_set_quality(&encoder, quality, TRUE);
  encoder.restart_interval = span;
  encoder.optimize_coding = span == 0 ? TRUE : FALSE;
  jpeg_start_compress(&encoder, TRUE);
  const std::size_t row = std::size_t{picture.width} * picture.channels;
  while (encoder.next_scanline < encoder.image_height) {
    JSAMPROW rows[] = {const_cast<JSAMPROW>(picture.bytes.data() + row * encoder.next_scanline)};
    jpeg_write_scanlines(&encoder, rows, 1);
  }
  jpeg_finish_compress(&encoder);
  return true;
}

std::vector<std::uint8_t> write_jpeg(const Picture& picture, int quality, std::uint32_t span) {
  if (picture.channels != 1 && picture.channels != 3) return {};
  if (picture.width == 0 || picture.height == 0 || picture.width > JPEG_MAX_DIMENSION ||
      picture.height > JPEG_MAX_DIMENSION ||
      picture.bytes.size() != std::size_t{picture.width} * picture.height * picture.channels)
    return {};
  JpegWriter writer;
  if (!write_rows(writer, picture, std::clamp(quality, 1, 100), span)) return {};
  return {writer.buffer, writer.buffer + writer.size};
}

}  // namespace

std::vector<std::uint8_t> encode_jpeg(const Picture& picture, int quality) {
  return write_jpeg(picture, quality, 0);
}

std::vector<std::uint8_t> write_striped_jpeg(const Picture& picture, int quality, std::uint32_t span) {
  return span == 0 ? std::vector<std::uint8_t>{} : write_jpeg(picture, quality, span);
}

StripedJpeg cut_at_markers(std::span<const std::uint8_t> jpeg) {
  StripedJpeg out;
  // Segments up to the start of the scan: a marker and the length of what follows it.
  std::size_t at = 2;
  while (at + 4 <= jpeg.size()) {
    const std::uint8_t marker = jpeg[at + 1];
    at += std::size_t{2} + static_cast<std::size_t>(jpeg[at + 2]) * 256 + jpeg[at + 3];
    if (marker == 0xda) break;
  }
  if (at >= jpeg.size()) return out;
  out.header = jpeg.first(at);
  for (std::size_t begin = at; at + 1 < jpeg.size();) {
    const void* found = std::memchr(jpeg.data() + at, 0xff, jpeg.size() - 1 - at);
    if (found == nullptr) break;
    at = static_cast<std::size_t>(static_cast<const std::uint8_t*>(found) - jpeg.data());
    const std::uint8_t next = jpeg[at + 1];
    if (next != 0) {
      out.stripes.push_back(jpeg.subspan(begin, at - begin));
      begin = at + 2;
    }
    if (next == 0xd9) break;
    at += 2;
  }
  return out;
}

}  // namespace adit::perception
