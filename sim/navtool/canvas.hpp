// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>
#include <vector>

#include "core/config/platform.hpp"
#include "core/geometry/pose.hpp"
#include "core/result/result.hpp"
#include "core/sketch/sketch.hpp"

namespace adit::sim::navtool {

/// A drawing in metres, seen from above.
class Canvas {
 public:
  /// Shows the corners `low` to `high`, m.
  Canvas(const Eigen::Vector2d& low, const Eigen::Vector2d& high, const std::string& title);
  void line(std::span<const Eigen::Vector2d> points, double thickness, Colour colour);
  void dot(const Eigen::Vector2d& at, double pixels, Colour colour);
  void body(const Platform& platform, const Pose2& pose, Colour colour);
  void legend(const std::string& text, Colour colour);
  /// Reason::cannot_write.
  Result<void> save(const std::string& file);

 private:
  double x(double wx) const { return 20 + (wx - low_.x()) * scale_; }
  double y(double wy) const { return 50 + (high_.y() - wy) * scale_; }
  Eigen::Vector2d low_, high_;
  double scale_;
  Sketch sketch_;
  double legend_x_{20};
};

}  // namespace adit::sim::navtool
