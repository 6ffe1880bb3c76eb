// SPDX-License-Identifier: Apache-2.0
#include "basestation/map/picture.hpp"

#include <algorithm>
#include <cmath>
#include <ostream>

#include "basestation/map/top_view.hpp"
#include "core/sketch/picture_frame.hpp"
#include "perception/map/export/map_file.hpp"

namespace adit::station {
namespace {

constexpr Colour kGround{1.0, 1.0, 0.995};
constexpr double kMargin = 34.0, kRow = 24.0;

Colour tone(const TopView::Cell& cell) {
  if (cell.kind == TopView::Kind::ground) return kGround;
  // 0.6 m is grey, 2 m and more nearly black.
  const double dark = std::clamp((cell.height - 1.0) / 9.0, 0.0, 1.0);
  return {0.66 - 0.50 * dark, 0.70 - 0.51 * dark, 0.75 - 0.51 * dark};
}

void draw_cells(Sketch& sketch, const TopView& view, const PictureFrame& frame) {
  for (int y = 0; y < view.ny(); ++y)
    for (int x = 0; x < view.nx();) {
      // Runs of equal cells as one rectangle on whole pixels: no seams.
      const TopView::Cell cell = view.at(x, y);
      const int first = x;
      while (x < view.nx() && view.at(x, y).kind == cell.kind && view.at(x, y).height == cell.height) ++x;
      if (cell.kind == TopView::Kind::unknown) continue;
      const double r = view.resolution();
      const double x0 = std::round(frame.x(view.low().x() + first * r)),
                   x1 = std::round(frame.x(view.low().x() + x * r)),
                   y0 = std::round(frame.y(view.low().y() + (y + 1) * r)),
                   y1 = std::round(frame.y(view.low().y() + y * r));
      sketch.fill(x0, y0, x1 - x0, y1 - y0, tone(cell));
    }
}

void draw_trail(Sketch& sketch, const PictureFrame& frame, const MapPicture::Robot& robot, double thickness,
                Colour colour) {
  cairo_set_source_rgba(sketch.cairo(), colour.r, colour.g, colour.b, colour.a);
  cairo_set_line_width(sketch.cairo(), thickness);
  for (const Pose2& p : robot.trail) cairo_line_to(sketch.cairo(), frame.x(p.x), frame.y(p.y));
  cairo_line_to(sketch.cairo(), frame.x(robot.now.x), frame.y(robot.now.y));
  cairo_stroke(sketch.cairo());
}

void draw_legend(Sketch& sketch, const MapPicture& picture, double top) {
  double y = top + kRow / 2;
  for (std::size_t n = 0; n < picture.robots.size(); ++n, y += kRow) {
    const MapPicture::Robot& robot = picture.robots[n];
    sketch.line(kMargin + 4, y, kMargin + 34, y, 5, kPalette[n % kPalette.size()]);
    sketch.text(kMargin + 46, y, 15, robot.name, kInk, Align::left, true);
    sketch.text(kMargin + 54 + sketch.text_width(15, robot.name, true), y, 15, robot.label, kInk);
  }
  double x = kMargin + 4;
  const auto entry = [&](Colour colour, const std::string& text) {
    sketch.rounded(x - 1, y - 8, 24, 16, 3, {0.6, 0.62, 0.65});
    sketch.rounded(x, y - 7, 22, 14, 2, colour);
    sketch.text(x + 30, y, 14, text, kInk);
    x += 46 + sketch.text_width(14, text);
  };
  entry(kGround, "free");
  entry(tone({TopView::Kind::low, 3}), "0.6 m");
  entry(tone({TopView::Kind::high, 5}), "1 m");
  entry(tone({TopView::Kind::high, 10}), "2 m and more");
  entry(kPaper, "not seen");
}

Result<void> save(Sketch& sketch, const std::string& file) {
  const std::string png = sketch.png();
  if (png.empty()) return {Reason::cannot_write, file + ": the picture could not be drawn"};
  return perception::write_file_atomically(file, [&](std::ostream& to) -> Result<void> {
    to << png;
    return {};
  });
}

}  // namespace

Result<void> write_map_picture(const perception::VoxelImage& image, const MapPicture& picture,
                               const std::string& file) {
  const TopView view(image);
  if (view.too_large()) return {Reason::bad_argument, "the map is too large for a picture"};
  if (view.nx() == 0 || picture.width < 400 || picture.width > 8000)
    return {Reason::map_empty, "there is no map yet"};
  PictureFrame frame{kMargin, view.low(),
                     view.low() + Eigen::Vector2d(view.nx(), view.ny()) * view.resolution()};
  for (const MapPicture::Robot& robot : picture.robots) {
    if (!robot.now.position().allFinite() || robot.now.position().norm() > 1e5) continue;
    frame.low = frame.low.cwiseMin(robot.now.position() - Eigen::Vector2d::Constant(1.0));
    frame.high = frame.high.cwiseMax(robot.now.position() + Eigen::Vector2d::Constant(1.0));
  }
  const Eigen::Vector2d extent = frame.high - frame.low;
  frame.scale = std::min((picture.width - 2 * kMargin) / extent.x(), 4000.0 / extent.y());
  const double below = frame.bottom() + 30.0;
  Sketch sketch(picture.width,
                static_cast<int>(below + kRow * (static_cast<double>(picture.robots.size()) + 1.0) + 20.0));
  sketch.fill(0, 0, picture.width, below + kRow * (static_cast<double>(picture.robots.size()) + 1.0) + 20.0,
              kPaper);
  draw_cells(sketch, view, frame);
  draw_grid(sketch, frame, extent.x() > 120 ? 20.0 : extent.x() > 12 ? 5.0 : 1.0);
  const double thick = std::clamp(frame.scale * 0.09, 2.0, 5.0);
  for (const MapPicture::Robot& robot : picture.robots)
    draw_trail(sketch, frame, robot, thick + 3.0, {1, 1, 1, 0.85});
  for (std::size_t n = 0; n < picture.robots.size(); ++n)
    draw_trail(sketch, frame, picture.robots[n], thick, kPalette[n % kPalette.size()]);
  for (std::size_t n = 0; n < picture.robots.size(); ++n)
    draw_body(sketch, frame, picture.robots[n].now, std::max(picture.robots[n].length * frame.scale, 9.0),
              std::max(picture.robots[n].width * frame.scale, 7.0), kPalette[n % kPalette.size()]);
  sketch.text(kMargin, 32, 26, picture.title, kInk, Align::left, true);
  sketch.text(kMargin, 62, 15, picture.subtitle, kFaint);
  draw_legend(sketch, picture, below);
  return save(sketch, file);
}

}  // namespace adit::station
