// SPDX-License-Identifier: Apache-2.0
#include "core/config/platform_file.hpp"

#include <cmath>

#include "core/config/node.hpp"
#include "core/config/search.hpp"
#include "core/config/sensors_file.hpp"

namespace adit::config {
namespace {

void read_footprint(const Node& root, Platform& p) {
  const Node node = root.child_if("footprint");
  if (!node.present()) return;
  for (const Node& corner : node.as_list()) {
    const std::vector<double> at = corner.as_numbers(2, 2, within(-2.5, 2.5));
    if (at.size() != 2) return;
    if (std::fabs(at[0]) > p.length / 2 + 1e-6 || std::fabs(at[1]) > p.width / 2 + 1e-6)
      corner.fail(Reason::out_of_range, "expected a corner within length and width");
    p.footprint.emplace_back(at[0], at[1]);
  }
  const std::size_t n = p.footprint.size();
  bool good = n >= 3 && n <= Platform::kMaxCorners;
  for (std::size_t i = 0; good && i < n; ++i) {
    const Eigen::Vector2d &a = p.footprint[i], &b = p.footprint[(i + 1) % n], &c = p.footprint[(i + 2) % n];
    const auto cross = [](const Eigen::Vector2d& u, const Eigen::Vector2d& v) {
      return u.x() * v.y() - u.y() * v.x();
    };
    good = cross(b - a, c - b) > 0 && cross(b - a, -a) > 0;  // Turns left, and base_link is on the left side.
  }
  if (!good)
    node.fail(Reason::out_of_range,
              "expected 3 to 16 corners [x, y], convex, counter-clockwise, around base_link");
}

/// Reads the keys of particular drives; for other drives such a key is unknown.
void read_drive(const Node& root, Platform& p) {
  static const std::vector<std::string> names{"differential", "tracked", "car", "holonomic", "aerial"};
  p.drive = static_cast<Drive>(root.choice("drive", names));
  if (p.drive == Drive::tracked) {
    p.turn_slip = root.number("turn_slip", within(0, 0.8), p.turn_slip);
    p.turn_error = root.number("turn_error", within(0, 0.5), p.turn_error);
  }
  if (p.drive == Drive::car) {
    p.wheelbase = root.number("wheelbase", above(0, 5));
    p.max_steering = root.number("max_steering", above(0, 1.2));
    p.steering_rate = root.number("steering_rate", above(0, 10), p.steering_rate);
  }
  if (p.drive == Drive::aerial) {
    p.hover_height = root.number("hover_height", above(0, 50), p.hover_height);
    p.max_climb = root.number("max_climb", above(0, 5), p.max_climb);
  }
}

}  // namespace

Result<Platform> load_platform_file(const std::string& path) {
  auto file = load(path);
  if (!file) return file.error();
  const Node& root = *file;
  Platform p;
  p.name = root.text("name");
  read_drive(root, p);
  p.length = root.number("length", above(0, 5));
  p.width = root.number("width", above(0, 5));
  read_footprint(root, p);
  p.height = root.number("height", above(0, 5), p.height);
  p.max_speed = root.number("max_speed", above(0, 10));
  p.max_turn = root.number("max_turn", above(0, 10));
  p.max_acceleration = root.number("max_acceleration", above(0, 20));
  p.max_turn_acceleration = root.number("max_turn_acceleration", above(0, 50), p.max_turn_acceleration);
  p.step = root.number("step", within(0, 1));
  p.max_slope = root.number("max_slope", within(0.05, 1.5), p.max_slope);
  const Node sensors = root.child_if("sensors");
  const bool has_lidar = sensors.is_mapping() && sensors.has("lidar");
  if (!has_lidar)
    p.lidar_height = root.number("lidar_height", above(0, 5));
  else if (root.has("lidar_height"))
    root.child("lidar_height")
        .fail(Reason::out_of_range, "expected no lidar_height beside a lidar of sensors, which has a z");
  p.lidar_rings = static_cast<int>(root.integer("lidar_rings", 2, 128, p.lidar_rings));
  p.lidar_lowest = root.number("lidar_lowest", within(-89, 0), p.lidar_lowest);
  p.lidar_highest = root.number("lidar_highest", within(0, 89), p.lidar_highest);
  p.max_tilt = root.number("max_tilt", above(0, 1.5), p.max_tilt);
  if (sensors.present()) {
    Sensors read = read_sensors(sensors, p.lidar(), p.flies());
    p.lidars = std::move(read.lidars);
    p.imu = std::move(read.imu);
  }
  if (!p.lidars.empty()) {
    p.lidar_height = p.lidars.front().mounting.z;
    p.lidar_rings = p.lidars.front().rings;
    p.lidar_lowest = p.lidars.front().lowest;
    p.lidar_highest = p.lidars.front().highest;
  }
  p.stairs = root.flag("stairs", false);
  p.router = root.text("router", p.router);
  p.planner = root.text("planner", p.planner);
  p.controller = root.text("controller", p.controller);
  p.path_curvature = root.number("path_curvature", above(0, 4), p.path_curvature);
  p.path_segment = root.number("path_segment", within(0.2, 2), p.path_segment);
  p.manual_collision_stop = root.flag("manual_collision_stop", p.manual_collision_stop);
  if (auto done = root.finish(); !done) return done.error();
  return p;
}

Result<Platform> load_platform(const std::string& name, const std::string& beside) {
  const auto path = find_named("platforms", name, beside);
  if (!path) return path.error();
  return load_platform_file(*path);
}

}  // namespace adit::config
