// SPDX-License-Identifier: Apache-2.0
#include "perception/camera/stripe_coding.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>

#include "perception/camera/jpeg_write.hpp"

namespace adit::perception {
namespace {

std::uint8_t least_span(const PictureFormat& format) {
  return static_cast<std::uint8_t>((format.mcus() + PictureFormat::kMaxStripes - 1) /
                                   PictureFormat::kMaxStripes);
}

/// Replaces the pixels of an MCU by the means of cells.
void flatten(Picture& picture, std::uint32_t x, std::uint32_t y, std::uint32_t width, std::uint32_t height,
             std::uint32_t cell) {
  const std::size_t row = std::size_t{picture.width} * picture.channels;
  for (std::uint32_t v = y; v < y + height; v += cell)
    for (std::uint32_t u = x; u < x + width; u += cell)
      for (std::size_t c = 0; c < picture.channels; ++c) {
        const std::uint32_t w = std::min(cell, x + width - u), h = std::min(cell, y + height - v);
        std::uint8_t* corner = picture.bytes.data() + v * row + u * picture.channels + c;
        std::uint32_t sum = 0;
        for (std::uint32_t j = 0; j < h; ++j)
          for (std::uint32_t i = 0; i < w; ++i) sum += corner[j * row + i * picture.channels];
        for (std::uint32_t j = 0; j < h; ++j)
          for (std::uint32_t i = 0; i < w; ++i)
            corner[j * row + i * picture.channels] = static_cast<std::uint8_t>(sum / (w * h));
      }
}

}  // namespace

CodedStripes::CodedStripes(const Picture& picture, const PictureFormat& format) {
  const std::vector<std::uint8_t> jpeg = write_striped_jpeg(picture, format.quality, format.span);
  const StripedJpeg parts = cut_at_markers(jpeg);
  bytes_.reserve(jpeg.size());
  for (const auto& part : parts.stripes) {
    bytes_.insert(bytes_.end(), part.begin(), part.end());
    ends_.push_back(bytes_.size());
  }
}

std::size_t CodedStripes::longest(std::size_t group) const {
  std::size_t most = 0;
  for (std::size_t i = 0; i < ends_.size(); i += group) {
    const std::size_t last = std::min(i + group, ends_.size()) - 1;
    most = std::max(most, ends_[last] - (i == 0 ? 0 : ends_[i - 1]));
  }
  return most;
}

CodedStripes code_with_new_span(const Picture& picture, PictureFormat& format, std::size_t max_stripe) {
  const std::uint8_t least = least_span(format);
  format.span = least;
  CodedStripes coded(picture, format);
  // Several stripes in one take no more bytes than they do apart.
  std::size_t group = std::min<std::uint32_t>(format.row(), 255) / least;
  while (group > 1 && coded.longest(group) > max_stripe * 3 / 4) --group;
  if (group > 1) {
    format.span = static_cast<std::uint8_t>(group * least);
    return {picture, format};
  }
  if (coded.longest() <= max_stripe) return coded;
  Picture coarser = picture;
  for (std::uint32_t cell = 2; cell <= 16 && coded.longest() > max_stripe; cell *= 2) {
    for (std::uint32_t i = 0; i < coded.count(); ++i)
      if (coded.stripe(i).size() > max_stripe)
        for_each_mcu(format, i, [&](std::uint32_t x, std::uint32_t y, std::uint32_t w, std::uint32_t h) {
          flatten(coarser, x, y, w, h, cell);
        });
    coded = CodedStripes(coarser, format);
  }
  return coded;
}

Picture in_channels_of(const Picture& picture, bool colour) {
  if (colour == (picture.channels == 3)) return picture;
  Picture out{picture.width, picture.height, static_cast<std::uint8_t>(colour ? 3 : 1), {}};
  const std::size_t pixels = std::size_t{picture.width} * picture.height;
  out.bytes.resize(pixels * out.channels);
  for (std::size_t i = 0; i < pixels; ++i) {
    if (colour) {
      std::fill_n(out.bytes.begin() + static_cast<std::ptrdiff_t>(3 * i), 3, picture.bytes[i]);
    } else {
      const std::uint8_t* rgb = picture.bytes.data() + 3 * i;
      out.bytes[i] = static_cast<std::uint8_t>((77 * rgb[0] + 150 * rgb[1] + 29 * rgb[2] + 128) >> 8);
    }
  }
  return out;
}

void mark_changed(const Picture& before, const Picture& now, const PictureFormat& format, double least,
                  std::vector<bool>& changed) {
  const std::size_t row = std::size_t{now.width} * now.channels, block = std::size_t{8} * now.channels;
  std::vector<std::uint32_t> sums((row + block - 1) / block);
  for (std::uint32_t y = 0; y < now.height; y += 8) {
    std::fill(sums.begin(), sums.end(), 0);
    const std::uint32_t rows = std::min(8U, now.height - y);
    for (std::uint32_t v = y; v < y + rows; ++v) {
      const std::uint8_t* a = before.bytes.data() + v * row;
      const std::uint8_t* b = now.bytes.data() + v * row;
      for (std::size_t i = 0; i < sums.size(); ++i) {
        const std::size_t end = std::min(row, (i + 1) * block);
        std::uint32_t sum = 0;
        for (std::size_t k = i * block; k < end; ++k)
          sum += static_cast<std::uint32_t>(std::abs(a[k] - b[k]));
        sums[i] += sum;
      }
    }
    for (std::size_t i = 0; i < sums.size(); ++i) {
      const std::size_t count = (std::min(row, (i + 1) * block) - i * block) * rows;
      if (static_cast<double>(sums[i]) > least * static_cast<double>(count))
        changed[format.stripe_at(static_cast<std::uint32_t>(8 * i), y)] = true;
    }
  }
}

}  // namespace adit::perception
