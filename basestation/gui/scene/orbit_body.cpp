// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/scene/orbit_body.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace adit::gui {
namespace {

using station::Robot;

double angle_of(double angle) { return std::abs(angle) < 10.0 ? angle : 0.0; }  // 0 for NaN, too.

class BodyDrawer {
 public:
  BodyDrawer(MarkList& out, const OrbitCamera& camera, const Robot& robot, const Point3& place,
             const BodyStyle& style)
      : out_(out), camera_(camera), place_(place), style_(style), kind_(robot.platform) {
    double length = robot.size.length, width = robot.size.width;
    if (!(length > 0.05 && length < 50.0 && width > 0.05 && width < 50.0)) length = width = extent_of(robot);
    half_length_ = length / 2;
    half_width_ = width / 2;
    high_ = tallness_of(robot);
    low_ = kind_ == "legged" ? 0.45 * high_ : 0.0;
    // Rz(yaw) Ry(pitch) Rx(roll), as in REP-103.
    const double yaw = angle_of(robot.yaw), pitch = angle_of(robot.pitch), roll = angle_of(robot.roll);
    const double cy = std::cos(yaw), sy = std::sin(yaw), cp = std::cos(pitch), sp = std::sin(pitch),
                 cr = std::cos(roll), sr = std::sin(roll);
    ahead_ = style.grow * Point3{cy * cp, sy * cp, -sp};
    left_ = style.grow * Point3{cy * sp * sr - sy * cr, sy * sp * sr + cy * cr, cp * sr};
    up_ = style.grow * Point3{cy * sp * cr + sy * sr, sy * sp * cr - cy * sr, cp * cr};
  }

  void draw() {
    const double l = half_length_, w = half_width_;
    const bool front = faces({l, 0, high_ / 2}, ahead_);
    if (!front) draw_wedge();
    if (kind_ == "legged") draw_legs();
    for (const double side : {-1.0, 1.0}) {
      if (faces({side * l, 0, high_ / 2}, side * ahead_))
        face({{side * l, -w, low_}, {side * l, w, low_}, {side * l, w, high_}, {side * l, -w, high_}}, 0.7);
      if (!faces({0, side * w, high_ / 2}, side * left_)) continue;
      face({{-l, side * w, low_}, {l, side * w, low_}, {l, side * w, high_}, {-l, side * w, high_}}, 0.5);
      draw_running_gear(side * w);
    }
    if (faces({0, 0, high_}, up_))
      face({{-l, -w, high_}, {l, -w, high_}, {l, w, high_}, {-l, w, high_}}, 1.0);
    if (faces({0, 0, low_}, -1.0 * up_))
      face({{-l, -w, low_}, {l, -w, low_}, {l, w, low_}, {-l, w, low_}}, 0.4);
    if (kind_ == "aerial") draw_rotors();
    if (front) draw_wedge();
  }

 private:
  Point3 at(const Point3& body) const { return place_ + body.x * ahead_ + body.y * left_ + body.z * up_; }
  /// Whether a side with that place, body frame, and outward normal is turned to the camera.
  bool faces(const Point3& centre, const Point3& normal) const {
    return dot(at(centre) - camera_.eye(), normal) < 0.0;
  }
  void add(const std::vector<Point3>& places, Shape shape) {
    for (const Point3& place : places) {
      const auto seen = camera_.project(at(place));
      if (!seen) return;
      shape.points.push_back(seen->at);
    }
    shape.opacity = style_.opacity;
    out_.shapes.push_back(std::move(shape));
  }
  void face(const std::vector<Point3>& places, double shade) {
    add(places, {.closed = true,
                 .line = Token::text,
                 .width = 1.2,
                 .dashed = style_.dashed,
                 .filled = true,
                 .fill = style_.fill,
                 .shade = shade});
  }
  void dark(const std::vector<Point3>& places) {
    add(places, {.closed = true, .line = Token::text, .width = 1.0, .filled = true, .shade = 0.0});
  }
  static std::vector<Point3> ring(const Point3& centre, double radius, bool upright) {
    std::vector<Point3> out;
    for (const Point& point : circle({centre.x, upright ? centre.z : centre.y}, radius, 12))
      out.push_back(upright ? Point3{point.x, centre.y, point.y} : Point3{point.x, point.y, centre.z});
    return out;
  }
  void draw_running_gear(double side) {
    const double l = half_length_, radius = std::min(0.3 * high_, 0.22 * l * 2);
    if (kind_ == "tracked")
      dark({{-l, side, 0}, {l, side, 0}, {l, side, 0.4 * high_}, {-l, side, 0.4 * high_}});
    if (kind_ == "wheeled" || kind_ == "car")
      for (const double x : {-0.6 * l, 0.6 * l}) dark(ring({x, side, radius}, radius, true));
  }
  void draw_legs() {
    for (const double x : {-0.85 * half_length_, 0.85 * half_length_})
      for (const double y : {-half_width_, half_width_})
        add({{x, y, low_}, {x - 0.12 * half_length_, y, low_ / 2}, {x, y, 0}},
            {.line = style_.fill, .width = 3.0});
  }
  void draw_rotors() {
    const double radius = 0.45 * std::min(half_length_, half_width_);
    for (const double x : {-half_length_, half_length_})
      for (const double y : {-half_width_, half_width_})
        add(ring({x, y, high_}, radius, false), {.closed = true, .line = style_.fill, .width = 2.0});
  }
  void draw_wedge() {
    const double l = half_length_, z = 0.6 * high_;
    face({{1.8 * l, 0, z}, {l, 0.7 * half_width_, z}, {l, -0.7 * half_width_, z}}, 1.0);
  }

  MarkList& out_;
  const OrbitCamera& camera_;
  Point3 place_{}, ahead_{}, left_{}, up_{};
  const BodyStyle& style_;
  const std::string& kind_;
  double half_length_{}, half_width_{}, low_{}, high_{};
};

}  // namespace

double tallness_of(const Robot& robot) {
  const double height = robot.size.height;
  return height > 0.05 && height < 50.0 ? height : 0.5 * extent_of(robot);
}

void add_body(MarkList& marks, const OrbitCamera& camera, const Robot& robot, const Point3& place,
              const BodyStyle& style) {
  BodyDrawer(marks, camera, robot, place, style).draw();
}

void add_axes(MarkList& marks, const OrbitCamera& camera, const Point& at, double mm) {
  struct Axis {
    Point3 direction{};
    Token token{};
    const char* name{};
  };
  const auto [right, down, ahead] = camera.axes();
  std::array axes{Axis{{1, 0, 0}, Token::bad, "x"}, Axis{{0, 1, 0}, Token::ok, "y"},
                  Axis{{0, 0, 1}, Token::mine, "z"}};
  // What points away from the eye is drawn first.
  const Point3& sight = ahead;
  std::ranges::stable_sort(axes, std::greater{},
                           [&](const Axis& axis) { return dot(axis.direction, sight); });
  for (const Axis& axis : axes) {
    const double x = dot(axis.direction, right), y = dot(axis.direction, down), length = 8.0 * mm;
    marks.shapes.push_back(
        {.points = {at, {at.x + length * x, at.y + length * y}}, .line = axis.token, .width = 3.0});
    marks.labels.push_back(
        {.at = {at.x + (length + 2.0 * mm) * x, at.y + (length + 2.0 * mm) * y}, .text = axis.name});
  }
}

}  // namespace adit::gui
