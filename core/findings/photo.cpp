// SPDX-License-Identifier: Apache-2.0
#include "core/findings/photo.hpp"

#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include <jpeglib.h>

namespace adit::findings {
namespace {

constexpr long kDecoderMemory = 64L << 20;  // Bytes.

/// The library's handler of errors: it jumps out of the call instead of ending the process.
struct JpegErrors {
  jpeg_error_mgr base{};
  std::jmp_buf jump{};
  bool too_many_scans{};
};

void leave_jpeg(j_common_ptr info) { std::longjmp(reinterpret_cast<JpegErrors*>(info->err)->jump, 1); }
void say_nothing(j_common_ptr) {}

jpeg_error_mgr* quiet_errors(JpegErrors& errors) {
  jpeg_error_mgr* base = jpeg_std_error(&errors.base);
  base->error_exit = leave_jpeg;
  base->output_message = say_nothing;
  return base;
}

/// Ends a decoder whose JPEG has more scans than any camera writes: each scan of few bytes costs all pixels.
void watch_scans(j_common_ptr info) {
  const auto* decoder = reinterpret_cast<j_decompress_ptr>(info);
  if (decoder->input_scan_number <= Photo::kMaxScans) return;
  reinterpret_cast<JpegErrors*>(info->err)->too_many_scans = true;
  leave_jpeg(info);
}

/// The outcome of a decoder, without anything that has a destructor, as the library jumps.
enum class Decoded : std::uint8_t { good, damaged, too_large, scans, colours, stopped };

/// Reads the header, and chooses a scale of n/8 at which the longer side has at least Photo::kSide.
Decoded begin_decoder(jpeg_decompress_struct& decoder, std::span<const std::uint8_t> jpeg) {
  jpeg_mem_src(&decoder, jpeg.data(), static_cast<unsigned long>(jpeg.size()));
  decoder.mem->max_memory_to_use = kDecoderMemory;
  if (jpeg_read_header(&decoder, TRUE) != JPEG_HEADER_OK) return Decoded::damaged;
  const std::uint64_t width = decoder.image_width, height = decoder.image_height;
  if (width > Photo::kMaxSide || height > Photo::kMaxSide || width * height > Photo::kMaxPixels)
    return Decoded::too_large;
  if (decoder.jpeg_color_space == JCS_CMYK || decoder.jpeg_color_space == JCS_YCCK) return Decoded::colours;
  decoder.out_color_space = JCS_RGB;
  decoder.scale_denom = 8;
  decoder.scale_num = 8;
  while (decoder.scale_num > 1 && std::max(width, height) * (decoder.scale_num - 1) >= 8ULL * Photo::kSide)
    --decoder.scale_num;
  return Decoded::good;
}

Decoded decode_into(PhotoPixels& pixels, std::span<const std::uint8_t> jpeg, const std::stop_token& stop) {
  jpeg_decompress_struct decoder{};
  JpegErrors errors{};
  jpeg_progress_mgr progress{};
  decoder.err = quiet_errors(errors);
  progress.progress_monitor = watch_scans;
  if (setjmp(errors.jump) != 0) {
    jpeg_destroy_decompress(&decoder);
    return errors.too_many_scans ? Decoded::scans : Decoded::damaged;
  }
  jpeg_create_decompress(&decoder);
  decoder.progress = &progress;
  Decoded outcome = begin_decoder(decoder, jpeg);
  if (outcome == Decoded::good) {
    jpeg_start_decompress(&decoder);
    pixels.width = decoder.output_width;
    pixels.height = decoder.output_height;
    pixels.rgb.resize(std::size_t{3} * pixels.width * pixels.height);
    while (decoder.output_scanline < decoder.output_height) {
      JSAMPROW row = pixels.rgb.data() + std::size_t{3} * pixels.width * decoder.output_scanline;
      jpeg_read_scanlines(&decoder, &row, 1);
      if (stop.stop_requested()) {
        jpeg_destroy_decompress(&decoder);
        return Decoded::stopped;
      }
    }
    jpeg_finish_decompress(&decoder);
    if (errors.base.num_warnings > 0) outcome = Decoded::damaged;  // Truncated, or damaged bytes.
  }
  jpeg_destroy_decompress(&decoder);
  return outcome;
}

Decoded read_header(std::span<const std::uint8_t> jpeg, std::uint32_t most) {
  jpeg_decompress_struct decoder{};
  JpegErrors errors{};
  decoder.err = quiet_errors(errors);
  if (setjmp(errors.jump) != 0) {
    jpeg_destroy_decompress(&decoder);
    return Decoded::damaged;
  }
  jpeg_create_decompress(&decoder);
  Decoded outcome = begin_decoder(decoder, jpeg);
  if (outcome == Decoded::good && std::max(decoder.image_width, decoder.image_height) > most)
    outcome = Decoded::too_large;
  jpeg_destroy_decompress(&decoder);
  return outcome;
}

/// Encodes pixels. The buffer is the library's: its owner frees it, also after a failure.
bool encode_into(unsigned char** buffer, unsigned long* size, const PhotoPixels& pixels, int quality) {
  jpeg_compress_struct encoder{};
  JpegErrors errors{};
  encoder.err = quiet_errors(errors);
  if (setjmp(errors.jump) != 0) {
    jpeg_destroy_compress(&encoder);
    return false;
  }
  jpeg_create_compress(&encoder);
  jpeg_mem_dest(&encoder, buffer, size);
  encoder.image_width = pixels.width;
  encoder.image_height = pixels.height;
  encoder.input_components = 3;
  encoder.in_color_space = JCS_RGB;
  jpeg_set_defaults(&encoder);
  jpeg_set_quality(&encoder, quality, TRUE);
  encoder.optimize_coding = TRUE;
  jpeg_start_compress(&encoder, TRUE);
  while (encoder.next_scanline < encoder.image_height) {
    auto* row =
        const_cast<JSAMPROW>(pixels.rgb.data() + std::size_t{3} * pixels.width * encoder.next_scanline);
    jpeg_write_scanlines(&encoder, &row, 1);
  }
  jpeg_finish_compress(&encoder);
  jpeg_destroy_compress(&encoder);
  return true;
}

store::Bytes to_jpeg(const PhotoPixels& pixels, int quality) {
  unsigned char* buffer = nullptr;
  unsigned long size = 0;
  const bool good = encode_into(&buffer, &size, pixels, quality);
  store::Bytes out;
  if (good) out.assign(buffer, buffer + size);
  std::free(buffer);
  return out;
}

/// The picture with its longer side at most so long, each pixel the mean of those that it covers.
PhotoPixels scaled(const PhotoPixels& from, std::uint32_t side) {
  const std::uint32_t longer = std::max(from.width, from.height);
  if (longer <= side) return from;
  PhotoPixels to{std::max(1U, from.width * side / longer), std::max(1U, from.height * side / longer), {}};
  to.rgb.resize(std::size_t{3} * to.width * to.height);
  for (std::uint32_t y = 0; y < to.height; ++y) {
    const std::uint32_t y0 = y * from.height / to.height,
                        y1 = std::max(y0 + 1, (y + 1) * from.height / to.height);
    for (std::uint32_t x = 0; x < to.width; ++x) {
      const std::uint32_t x0 = x * from.width / to.width,
                          x1 = std::max(x0 + 1, (x + 1) * from.width / to.width);
      std::array<std::uint32_t, 3> sum{};
      for (std::uint32_t v = y0; v < y1; ++v)
        for (std::uint32_t u = x0; u < x1; ++u)
          for (std::size_t c = 0; c < 3; ++c) sum[c] += from.rgb[3 * (std::size_t{v} * from.width + u) + c];
      const std::uint32_t count = (y1 - y0) * (x1 - x0);
      for (std::size_t c = 0; c < 3; ++c)
        to.rgb[3 * (std::size_t{y} * to.width + x) + c] = static_cast<std::uint8_t>(sum[c] / count);
    }
  }
  return to;
}

/// The best JPEG of the picture within so many bytes; empty: there is none.
store::Bytes compressed(PhotoPixels pixels, std::uint32_t side, std::size_t most,
                        std::span<const int> qualities) {
  for (; side >= 8; side = side * 2 / 3) {
    pixels = scaled(pixels, side);
    for (const int quality : qualities)
      if (store::Bytes out = to_jpeg(pixels, quality); !out.empty() && out.size() <= most) return out;
  }
  return {};
}

Error refusal_of(Decoded outcome, std::size_t bytes) {
  switch (outcome) {
    case Decoded::too_large:
      return {Reason::out_of_range,
              "a photo has more pixels than " + std::to_string(Photo::kMaxPixels / 1'000'000) +
                  " million, or a side of more than " + std::to_string(Photo::kMaxSide)};
    case Decoded::scans:
      return {Reason::out_of_range, "a photo has more than " + std::to_string(Photo::kMaxScans) + " scans"};
    case Decoded::colours:
      return {Reason::malformed, "a photo is a JPEG in CMYK: only grey and colour are read"};
    case Decoded::stopped:
      return {Reason::cancelled, "a photo was not decoded in time"};
    case Decoded::good:
    case Decoded::damaged:
      break;
  }
  return {Reason::malformed, "a photo of " + std::to_string(bytes) +
                                 " bytes is no whole JPEG: truncated, damaged, or of another format"};
}

bool is_jpeg(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= 4 && bytes[0] == 0xff && bytes[1] == 0xd8;
}

}  // namespace

std::uint64_t photo_hash(std::span<const std::uint8_t> bytes) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const std::uint8_t byte : bytes) hash = (hash ^ byte) * 0x100000001b3ULL;
  return hash;
}

Result<void> check_photo_size(std::size_t bytes) {
  if (bytes <= Photo::kMaxInput) return {};
  return {Reason::out_of_range, "a photo has " + std::to_string(bytes / 1024) + " kB, at most " +
                                    std::to_string(Photo::kMaxInput / 1024) + " are read"};
}

Result<void> check_photo_header(std::span<const std::uint8_t> jpeg, std::uint32_t most) {
  const Decoded outcome = is_jpeg(jpeg) ? read_header(jpeg, most) : Decoded::damaged;
  if (outcome != Decoded::good) return refusal_of(outcome, jpeg.size());
  return {};
}

Result<PhotoPixels> decode_photo(std::span<const std::uint8_t> jpeg, const std::stop_token& stop) {
  if (const auto readable = check_photo_size(jpeg.size()); !readable) return readable.error();
  if (!is_jpeg(jpeg)) return refusal_of(Decoded::damaged, jpeg.size());
  PhotoPixels pixels;
  if (const Decoded outcome = decode_into(pixels, jpeg, stop); outcome != Decoded::good)
    return refusal_of(outcome, jpeg.size());
  return pixels;
}

Result<Photo> make_photo(std::span<const std::uint8_t> jpeg, const std::stop_token& stop) {
  auto decoded = decode_photo(jpeg, stop);
  if (!decoded) return decoded.error();
  PhotoPixels pixels = std::move(*decoded);
  Photo photo;
  constexpr std::array kGood{85, 70, 55, 40};
  constexpr std::array kSmall{55, 40, 25};
  photo.picture = jpeg.size() <= Photo::kMaxBytes ? store::Bytes(jpeg.begin(), jpeg.end())
                                                  : compressed(pixels, Photo::kSide, Photo::kMaxBytes, kGood);
  photo.thumbnail = compressed(std::move(pixels), Photo::kThumbnailSide, Photo::kMaxThumbnail, kSmall);
  if (photo.picture.empty() || photo.thumbnail.empty())
    return Error{Reason::internal, "a photo could not be compressed"};
  photo.hash = photo_hash(photo.picture);
  return photo;
}

}  // namespace adit::findings
