// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <variant>
#include <vector>

#include "core/config/platform.hpp"
#include "core/geometry/pose.hpp"
#include "sim/world/simulation.hpp"

namespace adit::sim {

/// Drives to a place along the straight line from the step before.
struct DriveTo {
  Eigen::Vector2d place{0, 0};  ///< World, m.
  double speed{1.0};            ///< m/s, (0, the platform's limit].
};

/// Turns on the spot.
struct TurnBy {
  double angle{};    ///< Counter-clockwise, any number of turns, rad.
  double rate{1.0};  ///< rad/s, (0, the platform's limit].
};

/// Stands still.
struct StandFor {
  double time{};  ///< s, [0, 3600]
};

using DriveStep = std::variant<DriveTo, TurnBy, StandFor>;

/// A scripted drive of one robot.
struct DriveSpec {
  std::shared_ptr<const World> world{};
  Platform platform{};
  Pose2 start{};  ///< World.
  std::vector<DriveStep> steps{};
  std::uint64_t seed{1};
  double noise{1.0};     ///< Scale of all errors of odometry and sensors, [0, 10]; 0: the truth.
  bool realistic{true};  ///< The body tilts, the lidar sweeps, and there is an IMU; see SimulationParams.
  LidarParams lidar{};   ///< Rings and elevations come from the platform, unless it is planar.
  ImuParams imu{};       ///< The rate comes from the platform if it names an IMU.
  OdometryParams odometry{OdometryParams::realistic()};  ///< Before scaling by `noise`.
  std::vector<PersonSpec> people{};
  double dust{0.0};                  ///< Share of the beams that meet dust, [0, 0.5]. Realistic.
  std::optional<double> dropouts{};  ///< Share of the beams without return, [0, 1]. Realistic.
  double wheel_rate{50.0};           ///< Odometry samples a second, Hz, [1, 100].
};

}  // namespace adit::sim
