// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>

#include "core/geometry/pose.hpp"
#include "core/sketch/sketch.hpp"

namespace adit {

inline constexpr Colour kPaper{0.955, 0.95, 0.935}, kInk{0.13, 0.15, 0.19}, kFaint{0.42, 0.45, 0.50};
/// Colours of robots, by Okabe and Ito: also distinguishable for the colour-blind.
inline constexpr std::array<Colour, 6> kPalette{Colour{0.00, 0.45, 0.70}, {0.84, 0.37, 0.00},
                                                {0.00, 0.62, 0.45},       {0.80, 0.40, 0.65},
                                                {0.90, 0.62, 0.00},       {0.25, 0.60, 0.85}};

/// A rectangle of a map, m, as a part of a picture, pixels: below a header, inside a margin.
struct PictureFrame {
  static constexpr double kHeader = 84.0;
  double margin;
  Eigen::Vector2d low, high;
  double scale{1.0};  ///< Pixels per metre.

  double x(double map_x) const { return margin + (map_x - low.x()) * scale; }
  double y(double map_y) const { return kHeader + (high.y() - map_y) * scale; }
  double right() const { return x(high.x()); }
  double bottom() const { return y(low.y()); }
};

/// Draws a grid of `step` m with its coordinates, and a scale bar of one step.
void draw_grid(Sketch& sketch, const PictureFrame& frame, double step);
/// Draws a body with an arrow head that points forward; length and width in pixels.
void draw_body(Sketch& sketch, const PictureFrame& frame, const Pose2& pose, double length, double width,
               Colour colour);

}  // namespace adit
