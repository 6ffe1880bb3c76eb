// SPDX-License-Identifier: Apache-2.0
// What is made of stripes to be shown: a whole JPEG, and marks on the decoded picture.
#include <algorithm>

#include "perception/camera/jpeg_write.hpp"
#include "perception/camera/stripe_store.hpp"

namespace adit::perception {
namespace {

/// A JPEG of one stripe of grey.
std::vector<std::uint8_t> grey_stripe(const PictureFormat& format, std::uint32_t mcus) {
  Picture grey{mcus * format.mcu(), format.mcu(), static_cast<std::uint8_t>(format.colour ? 3 : 1), {}};
  grey.bytes.assign(std::size_t{grey.width} * grey.height * grey.channels, 128);
  return write_striped_jpeg(grey, format.quality, format.span);
}

/// Writes the size of the picture into the header of another one.
void set_size(std::span<std::uint8_t> header, const PictureFormat& format) {
  for (std::size_t at = 2; at + 9 <= header.size();) {
    if (header[at + 1] == 0xc0) {  // Start of a baseline frame: length, precision, height, width.
      header[at + 5] = static_cast<std::uint8_t>(format.height >> 8);
      header[at + 6] = static_cast<std::uint8_t>(format.height);
      header[at + 7] = static_cast<std::uint8_t>(format.width >> 8);
      header[at + 8] = static_cast<std::uint8_t>(format.width);
      return;
    }
    at += std::size_t{2} + static_cast<std::size_t>(header[at + 2]) * 256 + header[at + 3];
  }
}

bool has_bit(std::span<const std::uint8_t> bits, std::uint32_t index) {
  return index / 8 < bits.size() && (bits[index / 8] >> index % 8 & 1) != 0;
}

/// Copies the nearest pixel of a picture of another size and perhaps other channels.
void copy_nearest(const Picture& from, std::uint32_t x, std::uint32_t y, Picture& to) {
  const std::size_t u = std::size_t{x} * from.width / to.width, v = std::size_t{y} * from.height / to.height;
  const std::uint8_t* source = from.bytes.data() + (v * from.width + u) * from.channels;
  std::uint8_t* target = to.bytes.data() + (std::size_t{y} * to.width + x) * to.channels;
  for (std::size_t c = 0; c < to.channels; ++c)
    target[c] = source[from.channels == to.channels ? c : std::min<std::size_t>(1, from.channels - 1U)];
}

void grey_out(Picture& picture, std::uint32_t x, std::uint32_t y) {
  std::uint8_t* pixel = picture.bytes.data() + (std::size_t{y} * picture.width + x) * picture.channels;
  const int grey = picture.channels == 3 ? (77 * pixel[0] + 150 * pixel[1] + 29 * pixel[2]) >> 8 : pixel[0];
  std::fill_n(pixel, picture.channels, static_cast<std::uint8_t>(grey * 5 / 8));
}

bool is_whole(const Picture& picture) {
  return picture.width > 0 && picture.height > 0 && (picture.channels == 1 || picture.channels == 3) &&
         picture.bytes.size() == std::size_t{picture.width} * picture.height * picture.channels;
}

}  // namespace

std::vector<std::uint8_t> jpeg_of(const PictureFormat& format,
                                  const std::vector<const std::vector<std::uint8_t>*>& stripes) {
  if (!format.is_valid()) return {};
  const std::uint32_t count = format.stripes(), last_mcus = format.mcus() - (count - 1) * format.span;
  const std::vector<std::uint8_t> full = grey_stripe(format, format.span),
                                  last = grey_stripe(format, last_mcus);
  const StripedJpeg grey = cut_at_markers(full), last_grey = cut_at_markers(last);
  if (grey.stripes.size() != 1 || last_grey.stripes.size() != 1) return {};
  std::vector<std::uint8_t> out(grey.header.begin(), grey.header.end());
  set_size(out, format);
  for (std::uint32_t i = 0; i < count; ++i) {
    if (i > 0) {
      out.push_back(0xff);
      out.push_back(static_cast<std::uint8_t>(0xd0 + (i - 1) % 8));
    }
    if (i < stripes.size() && stripes[i] != nullptr && !stripes[i]->empty()) {
      out.insert(out.end(), stripes[i]->begin(), stripes[i]->end());
    } else {
      const auto part = i + 1 == count ? last_grey.stripes[0] : grey.stripes[0];
      out.insert(out.end(), part.begin(), part.end());
    }
  }
  out.push_back(0xff);
  out.push_back(0xd9);
  return out;
}

void mark_missing(Picture& picture, const PictureFormat& format, std::span<const std::uint8_t> marked,
                  std::span<const std::uint8_t> absent, const Picture& former) {
  if (!format.is_valid() || !is_whole(picture) || (marked.empty() && absent.empty())) return;
  const bool has_former = is_whole(former);
  for (std::uint32_t y = 0; y < picture.height; ++y) {
    const auto v = static_cast<std::uint32_t>(std::uint64_t{y} * format.height / picture.height);
    for (std::uint32_t x = 0; x < picture.width; ++x) {
      const auto u = static_cast<std::uint32_t>(std::uint64_t{x} * format.width / picture.width);
      const std::uint32_t stripe = format.stripe_at(u, v);
      const bool is_absent = has_bit(absent, stripe);
      if (is_absent && has_former) copy_nearest(former, x, y, picture);
      if (is_absent || has_bit(marked, stripe)) grey_out(picture, x, y);
    }
  }
}

}  // namespace adit::perception
