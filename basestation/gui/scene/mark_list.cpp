// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/scene/mark_list.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "basestation/gui/scene/state.hpp"
#include "basestation/model/numbering.hpp"
#include "basestation/model/route.hpp"
#include "basestation/model/text.hpp"

namespace adit::gui {
namespace {

using contract::GoalState;
using station::Robot;

constexpr double kMinRobotPixels = 14.0;  // So that a robot can be seen and hit at any scale.
constexpr double kReachLimit = 30.0;      // Radius in which a lost robot is expected, m.

class Drawer {
 public:
  explicit Drawer(const MarkScene& scene)
      : scene_(scene), camera_(scene.camera), numbers_(station::numbers_of(*scene.world)) {}

  MarkList draw() {
    const station::World& world = *scene_.world;
    for (const Robot& robot : world.robots)
      for (const Area& area : robot.areas) draw_area(area);
    for (const Robot& robot : world.robots) draw_trail(robot);
    for (const station::StationSummary& station : world.stations) draw_station(station);
    for (const Robot& robot : world.robots) draw_goal(robot);
    for (const Robot& robot : world.robots) draw_robot(robot);
    if (!scene_.sketch.empty()) {
      Shape area{.closed = true,
                 .line = Token::goal,
                 .width = 2.0,
                 .dashed = true,
                 .filled = true,
                 .fill = Token::goal,
                 .fill_opacity = 0.15};
      for (const Point& corner : scene_.sketch) area.points.push_back(camera_.to_screen(corner.x, corner.y));
      out_.shapes.push_back(std::move(area));
    }
    for (const Point& ghost : scene_.ghosts) {
      Shape mark = diamond(camera_.to_screen(ghost.x, ghost.y), 9.0, Token::goal);
      mark.fill_opacity = 0.45;
      mark.width = 2.0;
      mark.line = Token::goal;
      out_.shapes.push_back(mark);
    }
    return std::move(out_);
  }

 private:
  bool selected(const Robot& robot) const {
    return std::find(scene_.selection.begin(), scene_.selection.end(), robot.name) != scene_.selection.end();
  }
  /// `robot`: one of the world's.
  std::string number(const Robot& robot) const {
    return std::to_string(numbers_[static_cast<std::size_t>(&robot - scene_.world->robots.data())]);
  }

  void draw_area(const Area& area) {
    Shape shape{.closed = true,
                .line = area.kind == AreaKind::keep_out  ? Token::bad
                        : area.kind == AreaKind::keep_in ? Token::ok
                                                         : Token::goal,
                .width = 1.5,
                .dashed = area.kind == AreaKind::prefer,
                .filled = area.kind == AreaKind::keep_out,
                .fill = Token::bad,
                .fill_opacity = 0.15};
    for (const auto& corner : area.corners) {
      if (!drawable(corner[0], corner[1])) return;
      shape.points.push_back(camera_.to_screen(corner[0], corner[1]));
    }
    if (shape.points.size() < 3) return;
    // Robots of one holder have the same areas.
    for (const Shape& known : out_.shapes)
      if (known.closed && known.points == shape.points) return;
    out_.labels.push_back({.at = {shape.points[0].x, shape.points[0].y - 8},
                           .text = area.name + (area.kind == AreaKind::keep_out  ? ": keep out"
                                                : area.kind == AreaKind::keep_in ? ": keep in"
                                                                                 : ": prefer"),
                           .token = Token::dim});
    out_.shapes.push_back(std::move(shape));
  }

  void draw_trail(const Robot& robot) {
    const Trails::Trail* trail = scene_.trails ? scene_.trails->of(robot.name) : nullptr;
    if (!trail || trail->points.empty()) return;
    // Older quarters are paler.
    const auto quarter = [&](const Trails::Stamped& point) {
      return std::clamp(static_cast<int>(4.0 * (scene_.now - point.time) / Trails::kMaxAge), 0, 3);
    };
    Shape line{.line = robot.mine ? Token::mine : Token::dim, .width = 2.0};
    int fade = -1;
    const auto flush = [&] {
      if (line.points.size() > 1) out_.shapes.push_back(line);
    };
    for (const Trails::Stamped& point : trail->points) {
      const Point at = camera_.to_screen(point.place.x, point.place.y);
      if (const int now = quarter(point); point.begins || now != fade) {
        if (!point.begins && fade >= 0) line.points.push_back(at);
        flush();
        line.points.clear();
        fade = now;
        line.opacity = 0.7 - 0.15 * now;
      }
      line.points.push_back(at);
    }
    if (robot.located && drawable(robot.x, robot.y))
      line.points.push_back(camera_.to_screen(robot.x, robot.y));
    flush();
  }

  void draw_station(const station::StationSummary& station) {
    if (!station.place || !drawable((*station.place)[0], (*station.place)[1])) return;
    const Point at = camera_.to_screen((*station.place)[0], (*station.place)[1]);
    add_station(out_, station, at);
  }

  void draw_goal(const Robot& robot) {
    if (robot.goal_state == GoalState::none || robot.goal_state == GoalState::reached) return;
    if (!drawable(robot.goal[0], robot.goal[1])) return;
    const Point at = camera_.to_screen(robot.goal[0], robot.goal[1]);
    if (robot.located && drawable(robot.x, robot.y) && !draw_route(robot, at))
      out_.shapes.push_back({.points = {camera_.to_screen(robot.x, robot.y), at},
                             .line = Token::goal,
                             .width = 1.5,
                             .dashed = robot.goal_state != GoalState::active,
                             .opacity = 0.8});
    Shape mark = diamond(at, 9.0, Token::goal);
    out_.shapes.push_back(mark);
    out_.labels.push_back({.at = at, .text = number(robot), .on_fill = true});
    if (robot.goal_state == GoalState::blocked) cross_out(out_, at);
  }

  /// The way along the route; dashed where nothing was seen yet, and beyond what the robot sent of it.
  /// Returns false without a route.
  bool draw_route(const Robot& robot, const Point& goal) {
    const station::RouteRest rest = station::rest_of_route(robot);
    if (rest.points.empty()) return false;
    Shape line{.line = Token::goal, .width = selected(robot) ? 2.5 : 1.5, .opacity = 0.9};
    for (std::size_t leg = 0; leg < rest.unknown.size(); ++leg) {
      const auto& [x, y, z] = rest.points[leg];
      const auto& [next_x, next_y, next_z] = rest.points[leg + 1];
      if (!drawable(next_x, next_y)) return true;
      if (line.points.empty()) line.points.push_back(camera_.to_screen(x, y));
      line.points.push_back(camera_.to_screen(next_x, next_y));
      line.dashed = rest.unknown[leg] || robot.goal_state != GoalState::active;
      if (leg + 1 < rest.unknown.size() && rest.unknown[leg + 1] == rest.unknown[leg]) continue;
      out_.shapes.push_back(line);
      line.points.clear();
    }
    if (!rest.complete) {
      line.points = {camera_.to_screen(rest.points.back()[0], rest.points.back()[1]), goal};
      line.dashed = true;
      out_.shapes.push_back(line);
    }
    return true;
  }

  void draw_robot(const Robot& robot) {
    if (!robot.located || !drawable(robot.x, robot.y)) return;
    const Point at = camera_.to_screen(robot.x, robot.y);
    const double age = robot.age + scene_.silent;
    const double stale_after = scene_.trails ? scene_.trails->stale_after(robot.name) : 1.0;
    const bool old = contact_of(robot, scene_.silent, stale_after) != Contact::live;
    const double opacity = old ? 0.55 : 1.0;
    if (robot.sigma > 0.3 && std::isfinite(robot.sigma))
      out_.shapes.push_back({.points = circle(at, 2.0 * std::min(robot.sigma, 1e3) * camera_.scale),
                             .closed = true,
                             .line = Token::warn,
                             .width = 1.5,
                             .dashed = true,
                             .filled = true,
                             .fill = Token::warn,
                             .fill_opacity = 0.08});
    if (robot.lost) {
      const double reach = std::min(std::max(robot.max_speed, 0.5F) * age, kReachLimit);
      out_.shapes.push_back({.points = circle(at, reach * camera_.scale),
                             .closed = true,
                             .line = Token::dim,
                             .width = 1.0,
                             .dashed = true,
                             .filled = true,
                             .fill = Token::dim,
                             .fill_opacity = 0.05});
    }
    draw_body(robot, at, old, opacity);
    const double radius = std::max(kMinRobotPixels, extent_of(robot) * camera_.scale / 2);
    std::string label = robot.name;
    if (owner_of(robot) == Token::other) label += ", " + robot.holder;
    if (robot.lost) label += " lost " + station::fixed(age, 0) + " s";
    out_.labels.push_back({.at = {at.x, at.y + radius + (selected(robot) ? 19 : 9)},
                           .text = label,
                           .opacity = old ? 0.8 : 1.0});
    out_.targets.push_back({.robot = robot.name, .at = at, .radius = std::max(radius, 6.0 * scene_.mm)});
  }

  void draw_body(const Robot& robot, const Point& at, bool old, double opacity) {
    double length = robot.size.length, width = robot.size.width;
    if (!(length > 0.05 && length < 50.0 && width > 0.05 && width < 50.0)) length = width = extent_of(robot);
    const double grow = std::max(1.0, kMinRobotPixels / (std::min(length, width) * camera_.scale));
    const double half_length = length * camera_.scale * grow / 2,
                 half_width = width * camera_.scale * grow / 2;
    const double yaw = std::isfinite(robot.yaw) ? robot.yaw : 0.0;
    const double c = std::cos(yaw + camera_.turn), s = std::sin(yaw + camera_.turn);
    // From the body frame (x ahead, y left, pixels) to the screen, whose y points down.
    const auto place = [&](double x, double y) { return Point{at.x + c * x - s * y, at.y - s * x - c * y}; };
    const Token owner = owner_of(robot);
    const double ring = std::hypot(half_length, half_width) + 4;
    if (selected(robot))
      out_.shapes.push_back(
          {.points = circle(at, ring + 4), .closed = true, .line = Token::text, .width = 3.0});
    if (robot.stopped)
      out_.shapes.push_back({.points = {{at.x - ring, at.y - ring},
                                        {at.x + ring, at.y - ring},
                                        {at.x + ring, at.y + ring},
                                        {at.x - ring, at.y + ring}},
                             .closed = true,
                             .line = Token::bad,
                             .width = 3.5});
    out_.shapes.push_back({.points = {place(half_length, half_width), place(-half_length, half_width),
                                      place(-half_length, -half_width), place(half_length, -half_width)},
                           .closed = true,
                           .line = Token::text,
                           .width = 1.5,
                           .dashed = old,
                           .filled = true,
                           .fill = owner,
                           .opacity = opacity});
    // A wedge ahead of the body shows the heading.
    const double tip = half_length + 9;
    out_.shapes.push_back({.points = {place(tip, 0), place(half_length, half_width * 0.7),
                                      place(half_length, -half_width * 0.7)},
                           .closed = true,
                           .line = Token::text,
                           .width = 1.0,
                           .filled = true,
                           .fill = owner,
                           .opacity = opacity});
    const double speed = std::hypot(robot.vx, robot.vy);
    if (!old && speed > 0.05 && speed < 50.0) {  // Where it is in 2 s.
      const double ahead = 2.0 * camera_.scale;
      out_.shapes.push_back(
          {.points = {at, place(robot.vx * ahead, robot.vy * ahead)}, .line = Token::text, .width = 1.5});
    }
    out_.labels.push_back({.at = at, .text = number(robot), .on_fill = true, .opacity = opacity});
  }

  const MarkScene& scene_;
  const Camera& camera_;
  std::vector<int> numbers_;
  MarkList out_{};
};

}  // namespace

std::vector<Point> circle(const Point& centre, double radius, int corners) {
  std::vector<Point> points;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / corners;
    points.push_back({centre.x + radius * std::cos(angle), centre.y + radius * std::sin(angle)});
  }
  return points;
}

Shape diamond(const Point& at, double radius, Token fill) {
  return {
      .points = {{at.x, at.y - radius}, {at.x + radius, at.y}, {at.x, at.y + radius}, {at.x - radius, at.y}},
      .closed = true,
      .line = Token::text,
      .width = 1.0,
      .filled = true,
      .fill = fill};
}

void add_station(MarkList& marks, const station::StationSummary& station, const Point& at) {
  const double opacity = station.lost ? 0.5 : 1.0;
  marks.shapes.push_back({.points = {at, {at.x - 6, at.y - 14}, {at.x, at.y - 20}, {at.x + 6, at.y - 14}},
                          .closed = true,
                          .line = Token::text,
                          .width = 1.0,
                          .dashed = station.lost,
                          .filled = true,
                          .fill = station.self ? Token::mine : Token::other,
                          .opacity = opacity});
  marks.labels.push_back({.at = {at.x, at.y - 28}, .text = station.name, .opacity = opacity});
}

void cross_out(MarkList& marks, const Point& at) {
  for (const double side : {-1.0, 1.0})
    marks.shapes.push_back({.points = {{at.x - 12, at.y - side * 12}, {at.x + 12, at.y + side * 12}},
                            .line = Token::bad,
                            .width = 3.0});
}

void add_ring(MarkList& marks, const Point& at, double share, double mm) {
  constexpr int kSteps = 48;
  Shape ring{.points = circle(at, 8.0 * mm, kSteps), .closed = true, .line = Token::dim, .width = 2.0};
  const auto filled = static_cast<std::ptrdiff_t>(std::clamp(share, 0.0, 1.0) * kSteps);
  Shape arc{.points = {ring.points.begin(), ring.points.begin() + filled}, .line = Token::goal, .width = 6.0};
  arc.closed = filled == kSteps;
  marks.shapes.push_back(std::move(ring));
  if (arc.points.size() > 1) marks.shapes.push_back(std::move(arc));
}

double extent_of(const Robot& robot) {
  const double both = std::max<double>(robot.size.length, robot.size.width);
  return both > 0.05 && both < 50.0 ? both : 0.8;
}

const Target* MarkList::target_at(double x, double y) const {
  const Target* nearest = nullptr;
  double best = 1e9;
  for (const Target& target : targets) {
    const double distance = std::hypot(target.at.x - x, target.at.y - y);
    if (distance > target.radius || distance >= best) continue;
    best = distance;
    nearest = &target;
  }
  return nearest;
}

std::string MarkList::robot_at(double x, double y) const {
  const Target* target = target_at(x, y);
  return target ? target->robot : std::string();
}

MarkList marks_of(const MarkScene& scene) { return scene.world ? Drawer(scene).draw() : MarkList{}; }

double bar_length(double scale, double max_pixels) {
  const double most = max_pixels / std::max(scale, 1e-6);
  const double power = std::pow(10.0, std::floor(std::log10(most)));
  for (const double step : {5.0, 2.0})
    if (step * power <= most) return step * power;
  return power;
}

std::vector<Point> spread(const Point& centre, std::size_t count, double spacing) {
  std::vector<Point> places;
  if (count > 0) places.push_back(centre);
  for (int ring = 1; places.size() < count; ++ring) {
    const int slots = 6 * ring;
    for (int i = 0; i < slots && places.size() < count; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / slots;
      places.push_back(
          {centre.x + ring * spacing * std::cos(angle), centre.y + ring * spacing * std::sin(angle)});
    }
  }
  return places;
}

}  // namespace adit::gui
