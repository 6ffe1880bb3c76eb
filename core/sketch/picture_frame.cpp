// SPDX-License-Identifier: Apache-2.0
#include "core/sketch/picture_frame.hpp"

#include <cmath>
#include <string>

namespace adit {
namespace {

constexpr Colour kGridTone{0.35, 0.45, 0.55, 0.16};

std::string rounded_text(double metres) { return std::to_string(std::lround(metres)); }

}  // namespace

void draw_grid(Sketch& sketch, const PictureFrame& frame, double step) {
  for (double x = std::ceil(frame.low.x() / step) * step; x <= frame.high.x(); x += step) {
    sketch.line(frame.x(x), PictureFrame::kHeader, frame.x(x), frame.bottom(), 1.0, kGridTone);
    sketch.text(frame.x(x), frame.bottom() + 13, 12, rounded_text(x), kFaint, Align::centre);
  }
  for (double y = std::ceil(frame.low.y() / step) * step; y <= frame.high.y(); y += step) {
    sketch.line(frame.margin, frame.y(y), frame.right(), frame.y(y), 1.0, kGridTone);
    sketch.text(frame.margin - 6, frame.y(y), 12, rounded_text(y), kFaint, Align::right);
  }
  const double y = PictureFrame::kHeader - 16, x1 = frame.right(), x0 = x1 - step * frame.scale;
  sketch.line(x0, y, x1, y, 2.5, kInk);
  sketch.line(x0, y - 5, x0, y + 5, 2.5, kInk);
  sketch.line(x1, y - 5, x1, y + 5, 2.5, kInk);
  sketch.text(0.5 * (x0 + x1), y - 13, 13, rounded_text(step) + " m", kInk, Align::centre);
}

void draw_body(Sketch& sketch, const PictureFrame& frame, const Pose2& pose, double length, double width,
               Colour colour) {
  cairo_save(sketch.cairo());
  cairo_translate(sketch.cairo(), frame.x(pose.x), frame.y(pose.y));
  cairo_rotate(sketch.cairo(), -pose.yaw);
  sketch.rounded(-length / 2 - 2, -width / 2 - 2, length + 4, width + 4, 4, {1, 1, 1, 0.9});
  sketch.rounded(-length / 2, -width / 2, length, width, 3, colour);
  cairo_set_source_rgb(sketch.cairo(), 1, 1, 1);
  cairo_move_to(sketch.cairo(), 0.38 * length, 0);
  cairo_line_to(sketch.cairo(), 0.05 * length, 0.32 * width);
  cairo_line_to(sketch.cairo(), 0.05 * length, -0.32 * width);
  cairo_close_path(sketch.cairo());
  cairo_fill(sketch.cairo());
  cairo_restore(sketch.cairo());
}

}  // namespace adit
