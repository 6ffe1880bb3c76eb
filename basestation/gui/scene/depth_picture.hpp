// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "basestation/gui/scene/camera.hpp"
#include "basestation/gui/scene/colours.hpp"

namespace adit::gui {

/// A plane of the map as its inverse depth at pixel (column, row): base + per_column column + per_row row,
/// 1/m. In that form it needs no division for each pixel.
struct PlaneDepth {
  float base{}, per_column{}, per_row{};
  PlaneDepth times(float k) const { return {base * k, per_column * k, per_row * k}; }
};

/// A picture in which the nearest of what is drawn at a pixel stays.
class DepthPicture {
 public:
  static constexpr int kMaxSide = 8192;  ///< Pixels.

  /// Makes it empty. Sides are clamped to [1, kMaxSide].
  void clear(double width, double height, Rgb ground);
  int width() const { return width_; }
  int height() const { return height_; }
  /// Row by row from the top, 0xFFRRGGBB.
  const std::vector<std::uint32_t>& pixels() const { return pixels_; }
  /// In 1/m; 0 where nothing is.
  float inverse_depth(int column, int row) const { return inverse_[index(column, row)]; }

  /// Fills a square around a point with a plane that ends at the depths [1/far, 1/near], 1/m.
  void square(float x, float y, float half, const PlaneDepth& plane, float far, float near,
              std::uint32_t rgb);
  /// Fills a convex quadrangle, pixels.
  void quadrangle(const std::array<std::array<float, 2>, 4>& corners, const PlaneDepth& plane,
                  std::uint32_t rgb);
  /// Mixes a line of one pixel into what is farther. Each end: x, y in pixels, 1/m.
  void line(const std::array<double, 3>& from, const std::array<double, 3>& to, Rgb rgb, double share);
  /// Darkens what has something nearer beside it and brightens edges in front ("eye-dome lighting", Boucheny
  /// 2009). A plane stays as it is at every slope: its inverse depth has no second difference.
  void light();

 private:
  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(column);
  }

  int width_{}, height_{};
  std::vector<std::uint32_t> pixels_{};
  std::vector<float> inverse_{};
};

}  // namespace adit::gui
