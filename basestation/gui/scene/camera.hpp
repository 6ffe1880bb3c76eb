// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>

namespace adit::gui {

/// A point, of the screen (pixels, y down) or of the map frame (m, y up).
struct Point {
  double x{}, y{};
  bool operator==(const Point&) const = default;
};

/// Whether a place of the map frame, m, can be drawn: finite, and not farther than any site is large.
inline bool drawable(double x, double y) {
  constexpr double kFarthest = 1e5;
  return std::abs(x) < kFarthest && std::abs(y) < kFarthest;  // False for NaN, too.
}

/// The view from above of a part of the map frame. North (y of the map frame) is up, unless it is turned.
struct Camera {
  static constexpr double kMinScale = 0.05, kMaxScale = 400.0;

  double x{}, y{};             ///< Place at the centre of the view, map frame, m.
  double scale{20.0};          ///< Pixels per m, [kMinScale, kMaxScale].
  double width{1}, height{1};  ///< Size of the view, pixels.
  double turn{};               ///< Of the map on the screen, counter-clockwise, rad; see set_turn().
  double cos{1.0}, sin{0.0};   ///< Of `turn`.

  void set_turn(double angle) {
    turn = angle;
    cos = std::cos(angle);
    sin = std::sin(angle);
  }
  /// Turns the map so that this direction of the map frame is up, rad from x.
  void look_along(double yaw) {
    set_turn(std::remainder(std::numbers::pi / 2 - yaw, 2.0 * std::numbers::pi));
  }
  Point to_screen(double map_x, double map_y) const {
    const double dx = map_x - x, dy = map_y - y;
    return {width / 2 + (cos * dx - sin * dy) * scale, height / 2 - (sin * dx + cos * dy) * scale};
  }
  Point to_map(double screen_x, double screen_y) const {
    const double right = (screen_x - width / 2) / scale, up = (height / 2 - screen_y) / scale;
    return {x + cos * right + sin * up, y - sin * right + cos * up};
  }
  void pan(double dx, double dy) { place(to_map(width / 2, height / 2), width / 2 + dx, height / 2 + dy); }
  /// Moves the view, so that a place of the map is at that point of the screen.
  void place(const Point& at, double screen_x, double screen_y) {
    const Point there = to_map(screen_x, screen_y);
    x += at.x - there.x;
    y += at.y - there.y;
  }
  /// Changes the scale; the place at that point of the screen stays there.
  void zoom(double factor, double screen_x, double screen_y) {
    const Point fixed = to_map(screen_x, screen_y);
    scale = std::clamp(scale * factor, kMinScale, kMaxScale);
    place(fixed, screen_x, screen_y);
  }
  /// Shows a rectangle of the map frame, m, with a margin in pixels at each edge; north is up.
  void fit(const Point& low, const Point& high, double margin) {
    set_turn(0.0);
    x = (low.x + high.x) / 2;
    y = (low.y + high.y) / 2;
    const double across = std::max(high.x - low.x, 4.0), up = std::max(high.y - low.y, 4.0);
    const double room_x = std::max(width - 2 * margin, 10.0), room_y = std::max(height - 2 * margin, 10.0);
    scale = std::clamp(std::min(room_x / across, room_y / up), kMinScale, 120.0);
  }
  bool operator==(const Camera&) const = default;
  bool shows(const Point& place) const {
    const Point at = to_screen(place.x, place.y);
    return at.x >= 0 && at.y >= 0 && at.x <= width && at.y <= height;
  }
};

}  // namespace adit::gui
