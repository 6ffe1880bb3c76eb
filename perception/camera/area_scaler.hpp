// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "perception/camera/picture.hpp"

namespace adit::perception {

/// Width and height of a picture.
struct PictureSize {
  std::uint32_t width{}, height{};
  bool operator==(const PictureSize&) const = default;
};

/// The largest size within `bounds` that has the ratio of `from`, at most `from` itself.
PictureSize fitted(PictureSize from, PictureSize bounds);

/// Scales a picture down as its rows come: each pixel is the mean of the area that it covers.
class AreaScaler {
 public:
  /// @param to Not larger than `from`; neither has a side of 0.
  AreaScaler(PictureSize from, PictureSize to, std::uint8_t channels);
  /// Adds the next row, of from.width x channels bytes.
  void add(const std::uint8_t* row);
  /// The picture, after all rows were added.
  Picture take() { return std::move(picture_); }

 private:
  /// The source pixels of one pixel in a row. Weights are in 1 / to.width of a source pixel.
  struct Cover {
    std::uint32_t first{}, last{};
    std::uint32_t first_weight{}, last_weight{};
  };
  template <std::size_t Channels>
  void sum_row(const std::uint8_t* row);
  void add_sums(std::uint32_t weight);
  void finish_row();

  PictureSize from_, to_;
  std::uint32_t y_{}, target_y_{};
  std::vector<Cover> covers_{};
  std::vector<std::uint32_t> sums_{};  ///< Of the present source row, for each byte of a target row.
  std::vector<std::uint64_t> rows_{};  ///< Weighted sums of source rows.
  Picture picture_{};
};

}  // namespace adit::perception
