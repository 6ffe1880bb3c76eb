// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "perception/camera/picture.hpp"
#include "perception/camera/piece.hpp"

namespace adit::perception {

/// The entropy-coded data of all stripes of a picture, one after the other.
class CodedStripes {
 public:
  CodedStripes() = default;
  /// Codes a picture of the format's size and channels.
  CodedStripes(const Picture& picture, const PictureFormat& format);

  std::size_t count() const { return ends_.size(); }
  std::span<const std::uint8_t> stripe(std::size_t index) const {
    const std::size_t begin = index == 0 ? 0 : ends_[index - 1];
    return std::span(bytes_).subspan(begin, ends_[index] - begin);
  }
  /// Bytes of the longest one, of each `group` stripes that follow each other.
  std::size_t longest(std::size_t group = 1) const;

 private:
  std::vector<std::uint8_t> bytes_{};
  std::vector<std::size_t> ends_{};
};

/// Codes a picture with the largest span of which no stripe has more than three quarters of `max_stripe`
/// bytes, so that the span fits the next pictures too. Sets `format.span`. Where the least span that keeps
/// the number of stripes within its bound gives stripes of more than `max_stripe`, their pixels lose detail.
CodedStripes code_with_new_span(const Picture& picture, PictureFormat& format, std::size_t max_stripe);

/// Calls `visit(x, y, width, height)` with the pixels of each MCU of a stripe.
template <class Visit>
void for_each_mcu(const PictureFormat& format, std::uint32_t stripe, Visit&& visit) {
  const std::uint32_t end = std::min((stripe + 1) * format.span, format.mcus()), side = format.mcu();
  for (std::uint32_t i = stripe * format.span; i < end; ++i) {
    const std::uint32_t x = i % format.row() * side, y = i / format.row() * side;
    visit(x, y, std::min(side, format.width - x), std::min(side, format.height - y));
  }
}

/// The picture in the channels of the format.
Picture in_channels_of(const Picture& picture, bool colour);
/// Marks in `changed` the stripes with a block of 8 x 8 pixels whose mean difference is above `least`.
void mark_changed(const Picture& before, const Picture& now, const PictureFormat& format, double least,
                  std::vector<bool>& changed);

}  // namespace adit::perception
