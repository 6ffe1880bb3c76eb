#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/config/sensors.hpp"

namespace adit {

/// How a platform moves. `tracked` skids: less of a turn arrives than its tracks make. `car` steers its front
/// wheels: it turns only while it drives. `aerial` flies: sideways and up and down, too, and hovers.
enum class Drive { differential, tracked, car, holonomic, aerial };

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
  double turn_error{0.0};     ///< tracked: share by which odometry misjudges turns, its deviation, [0, 0.5]
  double wheelbase{0.0};      ///< car: between its axles, which lie evenly around base_link, m, (0, 5]
  double max_steering{0.0};   ///< car: of the front wheels, rad, (0, 1.2]
  double steering_rate{1.0};  ///< car: rad/s, (0, 10]
  double hover_height{1.0};   ///< aerial: base_link above the ground where no height is asked for, m, (0, 50]
  double max_climb{0.5};      ///< aerial: m/s up and down, (0, 5]
  double step{0.08};          ///< highest step it climbs, m, [0, 1]
  double max_slope{0.35};     ///< steepest ground it drives on, rise per run, [0.05, 1.5]
  double lidar_height{0.5};   ///< Of the first lidar above the ground, m, (0, 5]. See lidar().
  int lidar_rings{16};        ///< Of the first lidar: beams one above the other, [2, 128].
  double lidar_lowest{-15};   ///< Of the first lidar: elevation of the lowest beam, degrees, [-89, 0].
  double lidar_highest{15};   ///< Of the first lidar: elevation of the highest beam, degrees, [0, 89].
  std::vector<LidarConfig>
      lidars{};                    ///< `sensors:`; empty: one level lidar at lidar_height. See all_lidars().
  std::optional<ImuConfig> imu{};  ///< `sensors:`; none: roll and pitch are the odometry's.
  double max_tilt{
      0.0};  ///< Roll or pitch at which it may tip over, rad, (0, 1.5]; 0: from max_slope, Traversability.
  bool stairs{false};
  std::string router{"none"};           ///< that leads it round what the planner does not see: none or graph
  std::string planner{"trajectories"};  ///< that finds the way to a goal: nav/make_planner.hpp
  double path_curvature{0.0};  ///< largest of the planner's paths, rad/m, (0, 4]; 0: the planner's own choice
  double path_segment{0.0};    ///< of its trajectory library, m, [0.2, 2]; 0: the same
  std::string controller{"ilqr"};  ///< that tracks the planner's paths: nav/control/controller.hpp
  /// In manual mode the collision monitor stops the robot; false: it slows it and warns the operator.
  bool manual_collision_stop{false};

  /// All lidars; at least one.
  std::vector<LidarConfig> all_lidars() const {
    return lidars.empty() ? std::vector<LidarConfig>{lidar()} : lidars;
  }
  /// The first lidar. Its sweeps set the rate and the time of the scans.
  LidarConfig lidar() const {
    if (!lidars.empty()) return lidars.front();
    LidarConfig one;
    one.mounting.z = lidar_height;
    one.rings = lidar_rings;
    one.lowest = lidar_lowest;
    one.highest = lidar_highest;
    return one;
  }

  bool sideways() const { return drive == Drive::holonomic || drive == Drive::aerial; }
  /// Steepest ground it goes on, rise per run: stairs of its highest step are as steep.
  double steepest() const {
    constexpr double kTread = 0.28;  // m: of the steepest stairs
    return stairs ? std::max(max_slope, step / kTread) : max_slope;
  }
  bool turns_on_spot() const { return drive != Drive::car; }
  bool flies() const { return drive == Drive::aerial; }
  /// Behind base_link, m: what does not move sideways on a car. 0: base_link itself.
  double rear_axle() const { return drive == Drive::car ? wheelbase / 2 : 0.0; }
  /// Of the circle that its rear axle drives, m; 0 when it turns on the spot.
  double least_radius() const { return drive == Drive::car ? wheelbase / std::tan(max_steering) : 0.0; }
};

}  // namespace adit
