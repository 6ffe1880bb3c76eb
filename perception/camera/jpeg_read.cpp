// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "perception/camera/area_scaler.hpp"
#include "perception/camera/jpeg_errors.hpp"
#include "perception/camera/picture.hpp"

namespace adit::perception {
namespace {

constexpr long kReaderMemory = 64L << 20;  // Bytes.

/// A decoder, freed with its owner.
struct JpegReader {
  JpegReader() { decoder.err = jump.install(); }
  ~JpegReader() { jpeg_destroy_decompress(&decoder); }
  JpegReader(const JpegReader&) = delete;
  JpegReader& operator=(const JpegReader&) = delete;

  jpeg_decompress_struct decoder{};
  JpegJump jump{};
  jpeg_progress_mgr progress{};
};

/// Ends a decoder whose JPEG has more scans than any camera writes: each scan of few bytes costs all pixels.
void watch_scan_count(j_common_ptr info) {
  if (reinterpret_cast<j_decompress_ptr>(info)->input_scan_number <= kMaxJpegScans) return;
  reinterpret_cast<JpegJump*>(info->err)->too_many_scans = true;
  JpegJump::leave(info);
}

bool open_jpeg(JpegReader& reader, std::span<const std::uint8_t> jpeg) {
  if (setjmp(reader.jump.target) != 0) return false;
  jpeg_create_decompress(&reader.decoder);
  reader.progress.progress_monitor = watch_scan_count;
  reader.decoder.progress = &reader.progress;
  reader.decoder.mem->max_memory_to_use = kReaderMemory;
  jpeg_mem_src(&reader.decoder, jpeg.data(), static_cast<unsigned long>(jpeg.size()));
  return jpeg_read_header(&reader.decoder, TRUE) == JPEG_HEADER_OK;
}

bool start_jpeg(JpegReader& reader) {
  if (setjmp(reader.jump.target) != 0) return false;
  return jpeg_start_decompress(&reader.decoder) == TRUE;
}

/// @param row Room for a row of the decoder's output.
bool read_rows(JpegReader& reader, std::uint8_t* row, AreaScaler& scaler) {
  if (setjmp(reader.jump.target) != 0) return false;
  while (reader.decoder.output_scanline < reader.decoder.output_height) {
    JSAMPROW rows[] = {row};
    if (jpeg_read_scanlines(&reader.decoder, rows, 1) != 1) return false;
    scaler.add(row);
  }
  return jpeg_finish_decompress(&reader.decoder) == TRUE;
}

/// Decodes at the smallest n/8 of the size that is not below the wanted one.
void choose_scale(jpeg_decompress_struct& decoder, PictureSize wanted) {
  decoder.scale_denom = 8;
  decoder.scale_num = 8;
  const auto enough = [&](std::uint64_t num) {
    return decoder.image_width * num >= std::uint64_t{8} * wanted.width &&
           decoder.image_height * num >= std::uint64_t{8} * wanted.height;
  };
  while (decoder.scale_num > 1 && enough(decoder.scale_num - 1)) --decoder.scale_num;
}

bool begins_with(std::span<const std::uint8_t> bytes, std::string_view text) {
  return bytes.size() >= text.size() &&
         std::equal(text.begin(), text.end(), bytes.begin(),
                    [](char a, std::uint8_t b) { return static_cast<std::uint8_t>(a) == b; });
}

/// Why bytes are no JPEG, if their beginning says so.
std::optional<Error> other_format(std::span<const std::uint8_t> bytes) {
  struct Magic {
    std::string_view bytes, name;
  };
  constexpr std::array kFormats{
      Magic{"\x89PNG", "PNG"}, Magic{"GIF8", "GIF"}, Magic{"RIFF", "WebP"}, Magic{"BM", "BMP"},
      Magic{"II*", "TIFF"},    Magic{"MM", "TIFF"},  Magic{"P6", "PPM"},    Magic{"P5", "PGM"},
  };
  if (begins_with(bytes, "\xff\xd8")) return {};
  for (const Magic& format : kFormats)
    if (begins_with(bytes, format.bytes))
      return Error{Reason::not_supported,
                   "a compressed picture is in " + std::string(format.name) + ": only JPEG is read"};
  return Error{Reason::malformed, "a compressed picture is no JPEG"};
}

Error damaged_jpeg(const JpegReader& reader, std::size_t bytes) {
  if (reader.jump.too_many_scans)
    return {Reason::out_of_range, "a JPEG has more than " + std::to_string(kMaxJpegScans) + " scans"};
  return {Reason::malformed, "a JPEG of " + std::to_string(bytes) +
                                 " bytes is truncated, damaged, or of a kind that is not read"};
}

Result<Picture> decode_scaled(std::span<const std::uint8_t> jpeg, PictureSize bounds, bool strict) {
  if (bounds.width == 0 || bounds.height == 0)
    return {Reason::out_of_range, "a picture without pixels is asked for"};
  if (auto other = other_format(jpeg)) return *other;
  JpegReader reader;
  reader.jump.strict = strict;
  if (!open_jpeg(reader, jpeg)) return damaged_jpeg(reader, jpeg.size());
  jpeg_decompress_struct& decoder = reader.decoder;
  const PictureSize size{decoder.image_width, decoder.image_height};
  if (size.width > kMaxPictureSide || size.height > kMaxPictureSide ||
      std::uint64_t{size.width} * size.height > kMaxPicturePixels)
    return {Reason::out_of_range, "a JPEG has more than " + std::to_string(kMaxPicturePixels / 1'000'000) +
                                      " million pixels, or a side of more than " +
                                      std::to_string(kMaxPictureSide)};
  if (decoder.jpeg_color_space == JCS_CMYK || decoder.jpeg_color_space == JCS_YCCK)
    return {Reason::not_supported, "a JPEG is in CMYK: only grey and colour are read"};
  const bool grey = decoder.jpeg_color_space == JCS_GRAYSCALE;
  decoder.out_color_space = grey ? JCS_GRAYSCALE : JCS_RGB;
  if (!strict) decoder.do_fancy_upsampling = FALSE;
  const PictureSize wanted = fitted(size, bounds);
  choose_scale(decoder, wanted);
  if (!start_jpeg(reader)) return damaged_jpeg(reader, jpeg.size());
  const std::uint8_t channels = grey ? 1 : 3;
  AreaScaler scaler({decoder.output_width, decoder.output_height}, wanted, channels);
  std::vector<std::uint8_t> row(std::size_t{decoder.output_width} * channels);
  if (!read_rows(reader, row.data(), scaler)) return damaged_jpeg(reader, jpeg.size());
  return scaler.take();
}

}  // namespace

Result<Picture> decode_jpeg(std::span<const std::uint8_t> jpeg, std::uint32_t width, std::uint32_t height) {
  return decode_scaled(jpeg, {width, height}, true);
}

Result<Picture> decode_jpeg_tolerant(std::span<const std::uint8_t> jpeg, std::uint32_t width,
                                     std::uint32_t height) {
  return decode_scaled(jpeg, {width, height}, false);
}

}  // namespace adit::perception
