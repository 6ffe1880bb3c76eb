// SPDX-License-Identifier: Apache-2.0
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

/// Type of drive. `tracked` skids: the body turns less than the track speeds command. `car` steers its front
/// wheels and turns only while it drives. `aerial` flies: it also moves sideways, up and down, and hovers.
enum class Drive { differential, tracked, car, holonomic, aerial };

/// Geometry and capabilities of a robot's body, read from config/platforms/NAME.yaml. The footprint is a
/// rectangle centred on base_link, x forward, or a convex polygon within it.
struct Platform {
  static constexpr std::size_t kMaxCorners = 16;
  std::string name{};  ///< For example wheeled, tracked, legged.
  Drive drive{Drive::differential};
  double length{0.6};  ///< Footprint along x, m, (0, 5].
  double width{0.5};   ///< Footprint along y, m, (0, 5].
  /// Corners of the footprint, counter-clockwise, m; convex, around base_link, at most kMaxCorners; none: the
  /// rectangle.
  std::vector<Eigen::Vector2d> footprint{};
  double height{0.5};                 ///< Height of the body above the ground, m, (0, 5].
  double max_speed{1.0};              ///< m/s, (0, 10]
  double max_turn{1.0};               ///< rad/s, (0, 10]
  double max_acceleration{1.0};       ///< m/s2, (0, 20]
  double max_turn_acceleration{3.0};  ///< rad/s2, (0, 50]
  /// Tracked: share of each commanded turn that is lost by skidding, [0, 0.8]. The controller starts with it
  /// and adapts; the simulated ground uses it unchanged.
  double turn_slip{0.0};
  /// Tracked: standard deviation of the odometry's relative error in turns, [0, 0.5].
  double turn_error{0.0};
  /// Car: distance between the axles, which are equally far from base_link, m, (0, 5].
  double wheelbase{0.0};
  double max_steering{0.0};   ///< Car: largest steering angle of the front wheels, rad, (0, 1.2].
  double steering_rate{1.0};  ///< Car: rad/s, (0, 10].
  /// Aerial: height of base_link above the ground when no height is requested, m, (0, 50].
  double hover_height{1.0};
  double max_climb{0.5};     ///< Aerial: vertical speed, m/s, (0, 5].
  double step{0.08};         ///< Highest step that it climbs, m, [0, 1].
  double max_slope{0.35};    ///< Steepest ground that it drives on, rise per run, [0.05, 1.5].
  double lidar_height{0.5};  ///< Height of the first lidar above the ground, m, (0, 5]. See lidar().
  int lidar_rings{16};       ///< Rings of the first lidar, [2, 128].
  double lidar_lowest{-15};  ///< Elevation of the first lidar's lowest beam, degrees, [-89, 0].
  double lidar_highest{15};  ///< Elevation of the first lidar's highest beam, degrees, [0, 89].
  /// Key `sensors:`; empty: one level lidar at lidar_height. See all_lidars().
  std::vector<LidarConfig> lidars{};
  std::optional<ImuConfig> imu{};       ///< Key `sensors:`; none: roll and pitch come from the odometry.
  std::vector<CameraConfig> cameras{};  ///< Key `sensors:`; none: no pictures.
  /// Roll or pitch at which it may tip over, rad, (0, 1.5]; 0: from max_slope, see Traversability.
  double max_tilt{0.0};
  bool stairs{false};
  std::string router{"none"};  ///< Router around obstacles beyond the local planner's view: none or graph.
  std::string planner{"trajectories"};  ///< Planner of paths to a goal: nav/planners/make_planner.hpp.
  /// Largest curvature of the planner's paths, rad/m, (0, 4]; 0: the planner's default.
  double path_curvature{0.0};
  /// Segment length of its trajectory library, m, [0.2, 2]; 0: the planner's default.
  double path_segment{0.0};
  /// Controller that tracks the planner's paths: nav/control/controller.hpp.
  std::string controller{"ilqr"};
  /// In manual mode the collision monitor stops the robot; false: it slows the robot and warns the operator.
  bool manual_collision_stop{false};

  /// All lidars; at least one.
  std::vector<LidarConfig> all_lidars() const {
    return lidars.empty() ? std::vector<LidarConfig>{lidar()} : lidars;
  }
  /// The first lidar. Its sweeps determine the rate and the time of the scans.
  LidarConfig lidar() const {
    if (!lidars.empty()) return lidars.front();
    LidarConfig one;
    one.mounting.z = lidar_height;
    one.rings = lidar_rings;
    one.lowest = lidar_lowest;
    one.highest = lidar_highest;
    return one;
  }

  /// Where the first lidar's rays begin, base_link, m.
  Eigen::Vector3d lidar_origin() const {
    return lidars.empty() ? Eigen::Vector3d(0, 0, lidar_height) : lidars.front().mounting.position();
  }

  bool sideways() const { return drive == Drive::holonomic || drive == Drive::aerial; }
  /// Steepest ground that it drives on, rise per run; stairs of its highest step count.
  double steepest() const {
    constexpr double kTread = 0.28;  // Tread depth of the steepest stairs, m.
    return stairs ? std::max(max_slope, step / kTread) : max_slope;
  }
  /// `wanted` within the limits of speed, turn rate and climb, without a velocity that the drive does not
  /// have.
  Twist2 limited(const Twist2& wanted) const {
    Twist2 out = wanted;
    if (!sideways()) out.vy = 0.0;
    const double speed = std::hypot(out.vx, out.vy);
    if (speed > max_speed) {
      out.vx *= max_speed / speed;
      out.vy *= max_speed / speed;
    }
    out.wz = std::clamp(out.wz, -max_turn, max_turn);
    out.vz = flies() ? std::clamp(out.vz, -max_climb, max_climb) : 0.0;
    return out;
  }
  bool turns_on_spot() const { return drive != Drive::car; }
  bool flies() const { return drive == Drive::aerial; }
  /// Distance of the rear axle behind base_link, m; on a car this point does not move sideways. 0: base_link
  /// itself.
  double rear_axle() const { return drive == Drive::car ? wheelbase / 2 : 0.0; }
  /// Radius of the smallest circle of the rear axle, m; 0 when it turns on the spot.
  double least_radius() const { return drive == Drive::car ? wheelbase / std::tan(max_steering) : 0.0; }
};

}  // namespace adit
