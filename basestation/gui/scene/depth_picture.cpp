// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/scene/depth_picture.hpp"

#include <algorithm>
#include <cmath>

namespace adit::gui {
namespace {

constexpr std::uint32_t kOpaque = 0xFF000000U;
constexpr float kDarken = 40.0F, kBrighten = 20.0F;   // For each relative second difference of 1.
constexpr float kDarkest = 0.4F, kBrightest = 1.18F;  // Shares of a colour that no edge exceeds.

std::uint32_t scaled(std::uint32_t rgb, float share) {
  const auto k = static_cast<std::uint32_t>(share * 256.0F);
  std::uint32_t out = kOpaque;
  for (const int shift : {0, 8, 16})
    out |= std::min<std::uint32_t>(((rgb >> shift) & 0xFFU) * k >> 8, 255U) << shift;
  return out;
}

}  // namespace

void DepthPicture::clear(double width, double height, Rgb ground) {
  width_ = static_cast<int>(std::clamp(std::ceil(width), 1.0, double{kMaxSide}));
  height_ = static_cast<int>(std::clamp(std::ceil(height), 1.0, double{kMaxSide}));
  const std::size_t size = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  pixels_.assign(size, kOpaque | ground);
  inverse_.assign(size, 0.0F);
}

void DepthPicture::square(float x, float y, float half, const PlaneDepth& plane, float far, float near,
                          std::uint32_t rgb) {
  if (!(x + half >= 0 && y + half >= 0 && x - half < static_cast<float>(width_) &&
        y - half < static_cast<float>(height_)))
    return;
  const int left = std::max(0, static_cast<int>(x - half + 0.5F)),
            top = std::max(0, static_cast<int>(y - half + 0.5F));
  const int right = std::min(width_, std::max(left + 1, static_cast<int>(x + half + 0.5F))),
            bottom = std::min(height_, std::max(top + 1, static_cast<int>(y + half + 0.5F)));
  for (int row = top; row < bottom; ++row) {
    const float first = plane.base + plane.per_row * static_cast<float>(row);
    const std::size_t line = index(0, row);
    for (int column = left; column < right; ++column) {
      const float depth =
          std::min(std::max(first + plane.per_column * static_cast<float>(column), far), near);
      const std::size_t at = line + static_cast<std::size_t>(column);
      if (inverse_[at] >= depth) continue;
      inverse_[at] = depth;
      pixels_[at] = rgb;
    }
  }
}

void DepthPicture::quadrangle(const std::array<std::array<float, 2>, 4>& corners, const PlaneDepth& plane,
                              std::uint32_t rgb) {
  constexpr float kSeam = 0.01F;  // Pixels: roundings leave no gap between neighbours.
  float highest = corners[0][1], lowest = corners[0][1];
  for (const auto& corner : corners) {
    highest = std::min(highest, corner[1]);
    lowest = std::max(lowest, corner[1]);
  }
  if (!(lowest > 0.0F && highest < static_cast<float>(height_))) return;
  const int first = std::max(0, static_cast<int>(std::ceil(highest - 0.5F - kSeam)));
  const int last = std::min(height_ - 1, static_cast<int>(std::floor(lowest - 0.5F + kSeam)));
  for (int row = first; row <= last; ++row) {
    const float y = std::clamp(static_cast<float>(row) + 0.5F, highest, lowest);
    float left = 1e9F, right = -1e9F;
    for (std::size_t i = 0; i < 4; ++i) {
      const auto& a = corners[i];
      const auto& b = corners[(i + 1) % 4];
      if ((a[1] < y && b[1] < y) || (a[1] > y && b[1] > y)) continue;
      const float rise = b[1] - a[1];
      if (std::abs(rise) < 1e-6F) {
        left = std::min({left, a[0], b[0]});
        right = std::max({right, a[0], b[0]});
        continue;
      }
      const float x = a[0] + (y - a[1]) / rise * (b[0] - a[0]);
      left = std::min(left, x);
      right = std::max(right, x);
    }
    if (!(right > 0.0F && left < static_cast<float>(width_))) continue;
    const int begin = std::max(0, static_cast<int>(std::ceil(left - 0.5F - kSeam)));
    const int end = std::min(width_ - 1, static_cast<int>(std::floor(right - 0.5F + kSeam)));
    const float start = plane.base + plane.per_row * static_cast<float>(row);
    const std::size_t line = index(0, row);
    for (int column = begin; column <= end; ++column) {
      const float depth = start + plane.per_column * static_cast<float>(column);
      const std::size_t at = line + static_cast<std::size_t>(column);
      if (inverse_[at] >= depth) continue;
      inverse_[at] = depth;
      pixels_[at] = rgb;
    }
  }
}

void DepthPicture::line(const std::array<double, 3>& from, const std::array<double, 3>& to, Rgb rgb,
                        double share) {
  // The part in the picture, by Liang and Barsky.
  double begin = 0.0, end = 1.0;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const double size = (axis == 0 ? width_ : height_) - 1.0, length = to[axis] - from[axis];
    if (std::abs(length) < 1e-9) {
      if (from[axis] < 0.0 || from[axis] > size) return;
      continue;
    }
    const double one = -from[axis] / length, two = (size - from[axis]) / length;
    begin = std::max(begin, std::min(one, two));
    end = std::min(end, std::max(one, two));
  }
  if (!(begin < end)) return;
  const double length = std::max(std::abs(to[0] - from[0]), std::abs(to[1] - from[1])) * (end - begin);
  const int steps = static_cast<int>(std::clamp(std::ceil(length), 1.0, 2.0 * kMaxSide));
  for (int i = 0; i <= steps; ++i) {
    const double t = begin + (end - begin) * i / steps;
    const int column = static_cast<int>(std::lround(from[0] + t * (to[0] - from[0]))),
              row = static_cast<int>(std::lround(from[1] + t * (to[1] - from[1])));
    if (column < 0 || row < 0 || column >= width_ || row >= height_) continue;
    const std::size_t at = index(column, row);
    if (static_cast<double>(inverse_[at]) >= from[2] + t * (to[2] - from[2])) continue;
    pixels_[at] = kOpaque | mixed(pixels_[at] & 0xFFFFFFU, rgb, share);
  }
}

void DepthPicture::light() {
  const auto width = static_cast<std::ptrdiff_t>(width_);
  const auto bend = [](float before, float here, float after) {
    return before > 0.0F && after > 0.0F ? before + after - 2.0F * here : 0.0F;
  };
  for (int row = 1; row + 1 < height_; ++row) {
    const float* depth = inverse_.data() + row * width;
    std::uint32_t* pixel = pixels_.data() + row * width;
    for (std::ptrdiff_t column = 1; column + 1 < width; ++column) {
      const float here = depth[column];
      if (here <= 0.0F) continue;
      const float across = bend(depth[column - 1], here, depth[column + 1]),
                  down = bend(depth[column - width], here, depth[column + width]);
      const float nearer = across + down;
      if (std::abs(nearer) < 0.001F * here) continue;
      const float share = nearer > 0.0F ? std::max(kDarkest, here / (here + kDarken * nearer))
                                        : std::min(kBrightest, 1.0F - kBrighten * nearer / here);
      pixel[column] = scaled(pixel[column], share);
    }
  }
}

}  // namespace adit::gui
