// SPDX-License-Identifier: Apache-2.0
#include "core/config/platform_file.hpp"

#include <array>
#include <cmath>

#include "core/config/node.hpp"
#include "core/config/search.hpp"
#include "core/config/sensors_file.hpp"

namespace adit::config {
namespace {

/// Whether the polygon is convex, counter-clockwise, and has base_link, (0, 0), inside.
bool is_valid_footprint(const std::vector<Eigen::Vector2d>& corners) {
  const std::size_t n = corners.size();
  if (n < 3 || n > Platform::kMaxCorners) return false;
  const auto cross = [](const Eigen::Vector2d& u, const Eigen::Vector2d& v) {
    return u.x() * v.y() - u.y() * v.x();
  };
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector2d &a = corners[i], &b = corners[(i + 1) % n], &c = corners[(i + 2) % n];
    const bool turns_left = cross(b - a, c - b) > 0;
    const bool base_link_on_left = cross(b - a, -a) > 0;
    if (!turns_left || !base_link_on_left) return false;
  }
  return true;
}

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
  if (!is_valid_footprint(p.footprint))
    node.fail(Reason::out_of_range,
              "expected 3 to 16 corners [x, y], convex, counter-clockwise, around base_link");
}

/// Reads `drive`, and the keys that only some drives have. A file with such a key and another drive is
/// refused.
void read_drive(const Node& root, Platform& p) {
  static const std::vector<std::string> names{"differential", "tracked", "car", "holonomic", "aerial"};
  static constexpr std::array drives{Drive::differential, Drive::tracked, Drive::car, Drive::holonomic,
                                     Drive::aerial};  // In the order of `names`.
  p.drive = drives[root.choice("drive", names)];
  if (p.drive == Drive::tracked) {
    p.turn_slip = root.number("turn_slip", within(0, 0.8), p.turn_slip);
    p.turn_error = root.number("turn_error", within(0, 0.5), p.turn_error);
  }
  if (p.drive == Drive::car) {
    p.wheelbase = root.number("wheelbase", positive_up_to(5));
    p.max_steering = root.number("max_steering", positive_up_to(1.2));
    p.steering_rate = root.number("steering_rate", positive_up_to(10), p.steering_rate);
  }
  if (p.drive == Drive::aerial) {
    p.hover_height = root.number("hover_height", positive_up_to(50), p.hover_height);
    p.max_climb = root.number("max_climb", positive_up_to(5), p.max_climb);
  }
}

/// Reads length, width and height of the body, m.
void read_body(const Node& root, Platform& p) {
  p.length = root.number("length", positive_up_to(5));
  p.width = root.number("width", positive_up_to(5));
  read_footprint(root, p);
  p.height = root.number("height", positive_up_to(5), p.height);
}

/// Reads the limits of velocity (m/s, rad/s), acceleration (m/s2, rad/s2) and ground.
void read_motion_limits(const Node& root, Platform& p) {
  p.max_speed = root.number("max_speed", positive_up_to(10));
  p.max_turn = root.number("max_turn", positive_up_to(10));
  p.max_acceleration = root.number("max_acceleration", positive_up_to(20));
  p.max_turn_acceleration = root.number("max_turn_acceleration", positive_up_to(50), p.max_turn_acceleration);
  p.step = root.number("step", within(0, 1));                              // Height of a step, m.
  p.max_slope = root.number("max_slope", within(0.05, 1.5), p.max_slope);  // Rise per run.
}

/// Reads the keys of the first lidar of a platform that does not list it under `sensors:`.
void read_first_lidar(const Node& root, bool has_lidar_in_sensors, Platform& p) {
  if (!has_lidar_in_sensors)
    p.lidar_height = root.number("lidar_height", positive_up_to(5));
  else if (root.has("lidar_height"))
    root.child("lidar_height")
        .fail(Reason::out_of_range,
              "expected either lidar_height or a lidar under sensors, whose z is its height, not both");
  p.lidar_rings = static_cast<int>(root.integer("lidar_rings", 2, 128, p.lidar_rings));
  p.lidar_lowest = root.number("lidar_lowest", within(-89, 0), p.lidar_lowest);    // Degrees.
  p.lidar_highest = root.number("lidar_highest", within(0, 89), p.lidar_highest);  // Degrees.
}

/// Reads the choice of router, local planner and controller, and their parameters.
void read_navigation(const Node& root, Platform& p) {
  p.stairs = root.flag("stairs", false);
  p.router = root.text("router", p.router);
  p.planner = root.text("planner", p.planner);
  p.controller = root.text("controller", p.controller);
  p.path_curvature = root.number("path_curvature", positive_up_to(4), p.path_curvature);
  p.path_segment = root.number("path_segment", within(0.2, 2), p.path_segment);
  p.manual_collision_stop = root.flag("manual_collision_stop", p.manual_collision_stop);
}

}  // namespace

void read_platform_sensors(const Node& sensors, Platform& p) {
  if (!sensors.present()) return;
  Sensors read = read_sensors(sensors, p.lidar(), p.flies());
  p.lidars = std::move(read.lidars);
  p.cameras = std::move(read.cameras);
  p.imu = std::move(read.imu);
  if (p.lidars.empty()) return;
  p.lidar_height = p.lidars.front().mounting.z;
  p.lidar_rings = p.lidars.front().rings;
  p.lidar_lowest = p.lidars.front().lowest;
  p.lidar_highest = p.lidars.front().highest;
}

Result<Platform> load_platform_file(const std::string& path) {
  auto file = load(path);
  if (!file) return file.error();
  const Node& root = *file;
  Platform p;
  p.name = root.text("name");
  read_drive(root, p);
  read_body(root, p);
  read_motion_limits(root, p);
  const Node sensors = root.child_if("sensors");
  read_first_lidar(root, sensors.is_mapping() && sensors.has("lidar"), p);
  p.max_tilt = root.number("max_tilt", positive_up_to(1.5), p.max_tilt);  // rad
  read_platform_sensors(sensors, p);
  read_navigation(root, p);
  if (auto done = root.finish(); !done) return done.error();
  return p;
}

Result<Platform> load_platform(const std::string& name, const std::string& referring_file) {
  const auto path = find_named("platforms", name, referring_file);
  if (!path) return path.error();
  return load_platform_file(*path);
}

}  // namespace adit::config
