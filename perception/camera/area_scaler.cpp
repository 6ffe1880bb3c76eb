// SPDX-License-Identifier: Apache-2.0
#include "perception/camera/area_scaler.hpp"

#include <algorithm>
#include <array>

namespace adit::perception {

PictureSize fitted(PictureSize from, PictureSize bounds) {
  if (from.width <= bounds.width && from.height <= bounds.height) return from;
  const std::uint64_t w = from.width, h = from.height;
  if (w * bounds.height >= h * bounds.width)
    return {bounds.width, std::max(1U, static_cast<std::uint32_t>((h * bounds.width + w / 2) / w))};
  return {std::max(1U, static_cast<std::uint32_t>((w * bounds.height + h / 2) / h)), bounds.height};
}

AreaScaler::AreaScaler(PictureSize from, PictureSize to, std::uint8_t channels) : from_(from), to_(to) {
  picture_ = {to.width, to.height, channels, {}};
  picture_.bytes.resize(std::size_t{to.width} * to.height * channels);
  if (from == to) return;
  sums_.resize(std::size_t{to.width} * channels);
  rows_.resize(sums_.size());
  covers_.reserve(to.width);
  for (std::uint32_t x = 0; x < to.width; ++x) {
    const std::uint32_t begin = x * from.width, end = begin + from.width;
    Cover cover{begin / to.width, (end - 1) / to.width, 0, 0};
    cover.first_weight = std::min((cover.first + 1) * to.width, end) - begin;
    if (cover.last > cover.first) cover.last_weight = end - cover.last * to.width;
    covers_.push_back(cover);
  }
}

template <std::size_t Channels>
void AreaScaler::sum_row(const std::uint8_t* row) {
  std::uint32_t* out = sums_.data();
  for (const Cover& cover : covers_) {
    const std::uint8_t* first = row + std::size_t{cover.first} * Channels;
    const std::uint8_t* last = row + std::size_t{cover.last} * Channels;
    std::array<std::uint32_t, Channels> inner{};
    for (const std::uint8_t* pixel = first + Channels; pixel < last; pixel += Channels)
      for (std::size_t c = 0; c < Channels; ++c) inner[c] += pixel[c];
    for (std::size_t c = 0; c < Channels; ++c)
      *out++ = inner[c] * to_.width + first[c] * cover.first_weight + last[c] * cover.last_weight;
  }
}

void AreaScaler::add_sums(std::uint32_t weight) {
  for (std::size_t i = 0; i < sums_.size(); ++i) rows_[i] += std::uint64_t{weight} * sums_[i];
}

void AreaScaler::finish_row() {
  const double scale = 1.0 / (static_cast<double>(from_.width) * from_.height);
  std::uint8_t* out = picture_.bytes.data() + target_y_ * sums_.size();
  for (std::size_t i = 0; i < rows_.size(); ++i)
    out[i] = static_cast<std::uint8_t>(static_cast<double>(rows_[i]) * scale + 0.5);
  std::fill(rows_.begin(), rows_.end(), 0);
  ++target_y_;
}

void AreaScaler::add(const std::uint8_t* row) {
  if (y_ >= from_.height) return;
  const std::size_t bytes = std::size_t{from_.width} * picture_.channels;
  if (from_ == to_) {
    std::copy_n(row, bytes, picture_.bytes.data() + y_++ * bytes);
    return;
  }
  if (picture_.channels == 3)
    sum_row<3>(row);
  else
    sum_row<1>(row);
  // In 1 / to.height of a source row. A source row covers parts of at most two target rows.
  const std::uint32_t begin = y_ * to_.height, end = begin + to_.height;
  const std::uint32_t border = (target_y_ + 1) * from_.height;
  add_sums(std::min(end, border) - begin);
  if (end >= border) finish_row();
  if (end > border) add_sums(end - border);
  ++y_;
}

}  // namespace adit::perception
