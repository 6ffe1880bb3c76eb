// SPDX-License-Identifier: Apache-2.0
#include "sim/navtool/canvas.hpp"

#include <algorithm>

#include "core/result/result.hpp"

namespace adit::sim::navtool {
namespace {

constexpr double kWidth = 1200;  // pixels

double scale_for(const Eigen::Vector2d& low, const Eigen::Vector2d& high) {
  const Eigen::Vector2d size = (high - low).cwiseMax(0.5);
  return std::min((kWidth - 40) / size.x(), 1600 / size.y());
}

}  // namespace

Canvas::Canvas(const Eigen::Vector2d& low, const Eigen::Vector2d& high, const std::string& title)
    : low_(low),
      high_(high),
      scale_(scale_for(low, high)),
      sketch_(static_cast<int>(kWidth), static_cast<int>((high - low).y() * scale_) + 100) {
  sketch_.fill(0, 0, kWidth, (high - low).y() * scale_ + 100, {0.98, 0.98, 0.97});
  sketch_.text(20, 24, 18, title, {0.13, 0.15, 0.19}, Align::left, true);
}

void Canvas::line(std::span<const Eigen::Vector2d> points, double thickness, Colour colour) {
  for (std::size_t i = 0; i + 1 < points.size(); ++i)
    sketch_.line(x(points[i].x()), y(points[i].y()), x(points[i + 1].x()), y(points[i + 1].y()), thickness,
                 colour);
}

void Canvas::dot(const Eigen::Vector2d& at, double pixels, Colour colour) {
  sketch_.disc(x(at.x()), y(at.y()), pixels, colour);
}

void Canvas::body(const Platform& platform, const Pose2& pose, Colour colour) {
  const double l = platform.length / 2, w = platform.width / 2;
  std::vector<Eigen::Vector2d> corners;
  for (const auto& [cx, cy] : {std::pair{l, w}, {-l, w}, {-l, -w}, {l, -w}, {l, w}})
    corners.push_back(pose * Eigen::Vector2d(cx, cy));
  line(corners, 2, colour);
  line(std::vector<Eigen::Vector2d>{pose.position(), pose * Eigen::Vector2d(l, 0)}, 3, colour);
}

void Canvas::legend(const std::string& text, Colour colour) {
  const double bottom = 50 + (high_ - low_).y() * scale_ + 28;
  sketch_.disc(legend_x_ + 6, bottom, 6, colour);
  sketch_.text(legend_x_ + 18, bottom, 14, text, {0.13, 0.15, 0.19});
  legend_x_ += 40 + sketch_.text_width(14, text);
}

Result<void> Canvas::save(const std::string& file) {
  if (!sketch_.save(file)) return {Reason::cannot_write, file + ": the picture cannot be written"};
  return {};
}

}  // namespace adit::sim::navtool
