// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/scene/orbit_marks.hpp"

#include <algorithm>
#include <cmath>

#include "basestation/gui/scene/orbit_body.hpp"
#include "basestation/gui/scene/state.hpp"
#include "basestation/model/numbering.hpp"
#include "basestation/model/route.hpp"
#include "basestation/model/text.hpp"

namespace adit::gui {
namespace {

using contract::GoalState;
using station::Robot;

constexpr double kMinPixels = 26.0;  // Of a robot, so that its kind and its heading can be seen.

class OrbitDrawer {
 public:
  explicit OrbitDrawer(const OrbitScene& scene) : scene_(scene) {}

  MarkList draw() {
    for (const Robot& robot : scene_.world->robots) draw_areas(robot);
    for (const Robot& robot : scene_.world->robots) draw_trail(robot);
    for (const station::StationSummary& station : scene_.world->stations) draw_station(station);
    const std::vector<int> numbers = station::numbers_of(*scene_.world);
    for (std::size_t i = 0; i < numbers.size(); ++i)
      draw_goal(scene_.world->robots[i], std::to_string(numbers[i]));
    for (std::size_t i = 0; i < numbers.size(); ++i)
      draw_robot(scene_.world->robots[i], std::to_string(numbers[i]));
    for (const Point3& ghost : scene_.ghosts)
      if (const auto seen = scene_.camera.project(ghost)) {
        Shape mark = diamond(seen->at, 9.0, Token::goal);
        mark.fill_opacity = 0.45;
        mark.width = 2.0;
        mark.line = Token::goal;
        out_.shapes.push_back(std::move(mark));
      }
    add_axes(out_, scene_.camera, {13.0 * scene_.mm, scene_.camera.height - 13.0 * scene_.mm}, scene_.mm);
    return std::move(out_);
  }

 private:
  static double height_of(const Robot& robot) { return std::abs(robot.z) < 1e5F ? robot.z : 0.0; }

  /// Adds a shape through places of the map; none of it if a part is behind the camera.
  void add(const std::vector<Point3>& places, Shape shape) {
    for (const Point3& place : places) {
      const auto seen = scene_.camera.project(place);
      if (!seen) return;
      shape.points.push_back(seen->at);
    }
    if (shape.points.size() > 1) out_.shapes.push_back(std::move(shape));
  }

  void draw_areas(const Robot& robot) {
    for (const Area& area : robot.areas) {
      std::vector<Point3> corners;
      for (const auto& corner : area.corners)
        if (drawable(corner[0], corner[1])) corners.push_back({corner[0], corner[1], height_of(robot)});
      if (corners.size() < 3 || corners.size() != area.corners.size()) continue;
      const bool out = area.kind == AreaKind::keep_out;
      add(corners, {.closed = true,
                    .line = out                              ? Token::bad
                            : area.kind == AreaKind::keep_in ? Token::ok
                                                             : Token::goal,
                    .width = 1.5,
                    .dashed = area.kind == AreaKind::prefer,
                    .filled = out,
                    .fill = Token::bad,
                    .fill_opacity = 0.15});
    }
  }

  void draw_trail(const Robot& robot) {
    const Trails::Trail* trail = scene_.trails ? scene_.trails->of(robot.name) : nullptr;
    if (!trail) return;
    Shape line{.line = robot.mine ? Token::mine : Token::dim, .width = 2.0, .opacity = 0.6};
    const auto flush = [&] {
      if (line.points.size() > 1) out_.shapes.push_back(line);
      line.points.clear();
    };
    for (const Trails::Stamped& point : trail->points) {
      const auto seen = scene_.camera.project({point.place.x, point.place.y, point.z});
      if (!seen || point.begins) flush();
      if (seen) line.points.push_back(seen->at);
    }
    flush();
  }

  void draw_station(const station::StationSummary& station) {
    if (!station.place || !drawable((*station.place)[0], (*station.place)[1])) return;
    const auto seen = scene_.camera.project({(*station.place)[0], (*station.place)[1], (*station.place)[2]});
    if (!seen) return;
    add_station(out_, station, seen->at);
  }

  void draw_goal(const Robot& robot, const std::string& number) {
    if (robot.goal_state == GoalState::none || robot.goal_state == GoalState::reached) return;
    if (!drawable(robot.goal[0], robot.goal[1])) return;
    const double z = std::abs(robot.goal[2]) < 1e5 ? robot.goal[2] : height_of(robot);
    const Point3 goal{robot.goal[0], robot.goal[1], z};
    if (robot.located && drawable(robot.x, robot.y)) draw_way(robot, goal);
    const auto seen = scene_.camera.project(goal);
    if (!seen) return;
    out_.shapes.push_back(diamond(seen->at, 9.0, Token::goal));
    out_.labels.push_back({.at = seen->at, .text = number, .on_fill = true});
    if (robot.goal_state == GoalState::blocked) cross_out(out_, seen->at);
  }

  /// The rest of the route, or a line to the goal; dashed where nothing was seen yet.
  void draw_way(const Robot& robot, const Point3& goal) {
    const bool active = robot.goal_state == GoalState::active;
    const auto line = [&](const Point3& from, const Point3& to, bool dashed) {
      add({from, to}, {.line = Token::goal, .width = 1.5, .dashed = dashed || !active, .opacity = 0.8});
    };
    const station::RouteRest rest = station::rest_of_route(robot);
    Point3 from{robot.x, robot.y, height_of(robot)};
    for (std::size_t leg = 0; leg < rest.unknown.size(); ++leg) {
      const auto& [x, y, z] = rest.points[leg + 1];
      if (!drawable(x, y) || !(std::abs(z) < 1e5)) return;
      line(from, {x, y, z}, rest.unknown[leg]);
      from = {x, y, z};
    }
    if (!rest.complete) line(from, goal, !rest.points.empty());
  }

  void draw_robot(const Robot& robot, const std::string& number) {
    if (!robot.located || !drawable(robot.x, robot.y)) return;
    const Point3 centre{robot.x, robot.y, height_of(robot)};
    const auto seen = scene_.camera.project(centre);
    if (!seen) return;
    const bool old =
        contact_of(robot, scene_.silent, scene_.trails ? scene_.trails->stale_after(robot.name) : 1.0) !=
        Contact::live;
    const double opacity = (old ? 0.55 : 1.0) * (stands_in(scene_.slice, centre.z) ? 1.0 : 0.4);
    const double extent = extent_of(robot), scale = scene_.camera.focal() / seen->depth;
    const double grow = std::max(1.0, kMinPixels / (extent * scale));
    const double ring = grow * (extent * 0.65 + 0.1);
    const bool selected =
        std::find(scene_.selection.begin(), scene_.selection.end(), robot.name) != scene_.selection.end();
    const auto around = [&](double radius, int corners) {
      std::vector<Point3> places;
      for (const Point& at : circle({centre.x, centre.y}, radius, corners))
        places.push_back({at.x, at.y, centre.z});
      return places;
    };
    if (selected) add(around(ring * 1.3, 40), {.closed = true, .line = Token::text, .width = 3.0});
    if (robot.stopped) add(around(ring * 1.4, 4), {.closed = true, .line = Token::bad, .width = 3.5});
    add_body(out_, scene_.camera, robot, centre,
             {.fill = owner_of(robot), .dashed = old, .opacity = opacity, .grow = grow});
    const auto above = scene_.camera.project(centre + Point3{0, 0, grow * tallness_of(robot)});
    const Point top = above ? above->at : seen->at;
    // Its number on a pin, as on its card.
    const Point badge{top.x, top.y - 4.5 * scene_.mm};
    out_.shapes.push_back(
        {.points = {top, badge}, .line = owner_of(robot), .width = 2.0, .opacity = opacity});
    out_.shapes.push_back({.points = circle(badge, 2.3 * scene_.mm, 20),
                           .closed = true,
                           .line = Token::text,
                           .width = 1.0,
                           .filled = true,
                           .fill = owner_of(robot),
                           .opacity = opacity});
    out_.labels.push_back({.at = badge, .text = number, .on_fill = true, .opacity = opacity});
    std::string label = robot.name;
    if (owner_of(robot) == Token::other) label += ", " + robot.holder;
    if (robot.lost) label += " lost " + station::fixed(robot.age + scene_.silent, 0) + " s";
    const double radius = std::max(kMinPixels, grow * extent * scale / 2);
    out_.labels.push_back(
        {.at = {seen->at.x, seen->at.y + radius + 12}, .text = label, .opacity = old ? 0.8 : 1.0});
    out_.targets.push_back(
        {.robot = robot.name, .at = seen->at, .radius = std::max(radius, 6.0 * scene_.mm)});
  }

  const OrbitScene& scene_;
  MarkList out_{};
};

}  // namespace

MarkList orbit_marks(const OrbitScene& scene) { return scene.world ? OrbitDrawer(scene).draw() : MarkList{}; }

}  // namespace adit::gui
