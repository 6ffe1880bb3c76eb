// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "basestation/gui/scene/camera.hpp"
#include "basestation/gui/scene/colours.hpp"
#include "basestation/gui/scene/trails.hpp"
#include "basestation/model/world.hpp"

namespace adit::gui {

/// Lines and areas in pixels of the screen.
struct Shape {
  std::vector<Point> points{};
  bool closed{};  ///< A polygon, otherwise a line.
  Token line{Token::text};
  double width{1.5};  ///< Of the line, pixels; 0: none.
  bool dashed{};
  bool filled{};
  Token fill{Token::text};
  double opacity{1.0};       ///< Of the line and of the area, [0, 1].
  double fill_opacity{1.0};  ///< Of the area, beside `opacity`.
  double shade{1.0};         ///< Brightness of the area, [0, 1].
  bool operator==(const Shape&) const = default;
};

struct MapLabel {
  Point at{};  ///< Its centre, pixels.
  std::string text{};
  Token token{Token::text};
  bool on_fill{};  ///< Stands on a filled mark: in dark ink, bold.
  double opacity{1.0};
  bool operator==(const MapLabel&) const = default;
};

/// Where a tap on the map means a robot or a finding.
struct Target {
  std::string robot{};      ///< Empty: it is a finding.
  Point at{};               ///< Pixels.
  double radius{};          ///< Pixels.
  std::uint32_t finding{};  ///< Its number; 0: it is a robot.
  bool operator==(const Target&) const = default;
};

/// All that is drawn above the map, in the order of drawing.
struct MarkList {
  std::vector<Shape> shapes{};
  std::vector<MapLabel> labels{};
  std::vector<Target> targets{};

  /// What a tap at a point of the screen means, the nearest of several; null: nothing.
  const Target* target_at(double x, double y) const;
  /// The robot at a point of the screen; empty: none, or something else is nearer.
  std::string robot_at(double x, double y) const;
  bool operator==(const MarkList&) const = default;
};

/// What the marks depend on beside the world.
struct MarkScene {
  const station::World* world{};
  const Trails* trails{};
  Camera camera{};
  std::vector<std::string> selection{};
  std::vector<Point> ghosts{};  ///< Goals that would be sent, map frame, m.
  std::vector<Point> sketch{};  ///< Corners of an area that is being drawn, map frame, m.
  double now{};                 ///< Time as given to Trails::add(), s.
  double silent{};              ///< Time since the station's last snapshot, s.
  double mm{3.78};              ///< Pixels per mm.
};

/// Corners of a circle, in the units of its centre.
std::vector<Point> circle(const Point& centre, double radius, int corners = 40);
/// A mark of a goal, pixels.
Shape diamond(const Point& at, double radius, Token fill);
/// The pin of a station with its name, pixels.
void add_station(MarkList& marks, const station::StationSummary& station, const Point& at);
/// Crosses out a goal that cannot be reached, pixels.
void cross_out(MarkList& marks, const Point& at);
/// A ring around a place that is pressed, filled by that share, pixels. `mm`: pixels per mm.
void add_ring(MarkList& marks, const Point& at, double share, double mm);
/// The larger side of a robot, m; 0.8 if it is not known.
double extent_of(const station::Robot& robot);

/// The marks of a world. Robots whose place is not finite are left out.
MarkList marks_of(const MarkScene& scene);

/// Length of the scale bar, m: 1, 2 or 5 times a power of ten, at most `max_pixels` long.
double bar_length(double scale, double max_pixels);

/// Places for several robots around a point, map frame, m: the first at the point, the others on rings around
/// it, `spacing` apart.
std::vector<Point> spread(const Point& centre, std::size_t count, double spacing);

}  // namespace adit::gui
