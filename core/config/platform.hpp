#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

namespace adit {

/// How a platform moves. `tracked` skids: less of a turn arrives than its tracks make.
enum class Drive { differential, tracked, holonomic };

/// What a robot's body is and can do; read from config/platforms/NAME.yaml. Footprint: a rectangle
/// centred on base_link, x forward, or a convex polygon within it.
struct Platform {
  static constexpr std::size_t kMaxCorners = 16;
  std::string name{};  ///< wheeled, tracked, legged, ...
  Drive drive{Drive::differential};
  double length{0.6};  ///< footprint along x, m, (0, 5]
  double width{0.5};   ///< footprint along y, m, (0, 5]
  /// Corners, counter-clockwise, m; convex, around base_link, at most kMaxCorners; none: the rectangle.
  std::vector<Eigen::Vector2d> footprint{};
  double height{0.5};                 ///< of the body above the ground, m, (0, 5]
  double max_speed{1.0};              ///< m/s, (0, 10]
  double max_turn{1.0};               ///< rad/s, (0, 10]
  double max_acceleration{1.0};       ///< m/s2, (0, 20]
  double max_turn_acceleration{3.0};  ///< rad/s2, (0, 50]
  /// tracked: share of each turn that the ground swallows, [0, 0.8]; the controller begins with it, and
  /// learns; the simulated ground keeps to it.
  double turn_slip{0.0};
  double turn_error{0.0};    ///< tracked: share by which odometry misjudges turns, its deviation, [0, 0.5]
  double step{0.08};         ///< highest step it climbs, m, [0, 1]
  double lidar_height{0.5};  ///< above the ground, m, (0, 5]
  bool stairs{false};
  std::string router{"none"};           ///< that leads it round what the planner does not see: none or graph
  std::string planner{"trajectories"};  ///< that finds the way to a goal: nav/make_planner.hpp
  std::string controller{"ilqr"};       ///< that tracks the planner's paths: nav/control/controller.hpp
  /// In manual mode the collision monitor stops the robot; false: it slows it and warns the operator.
  bool manual_collision_stop{false};

  bool sideways() const { return drive == Drive::holonomic; }
};

}  // namespace adit
