// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <deque>

#include "sim/world/chassis.hpp"
#include "sim/world/imu.hpp"
#include "sim/world/sweep.hpp"

namespace adit::sim {

/// A lidar of a simulated robot.
struct MountedLidar {
  std::shared_ptr<const LidarPattern> pattern{};
  Pose3 T_base_lidar{};  ///< True.
  LidarErrors errors{};
};

/// What a simulated robot has beyond a level body with perfect sensors: suspension, inertial sensor, a lidar
/// that sweeps while the body moves and sits a little beside its nominal place.
struct Realism {
  /// Without patterns of the lidars. The sensors sit where the platform says; an inertial sensor that it does
  /// not name 0.2 m above base_link. `noise` scales every error; 0 leaves the motion of the body and of the
  /// sweep.
  Realism(const Platform& platform, const ImuParams& imu, double noise, std::uint64_t seed);

  Chassis chassis;
  Imu imu;
  std::vector<MountedLidar> lidars{};  ///< In the order of Platform::all_lidars().
  Attitude ground{};                   ///< Of the contact points, where the body last had ground.
  std::deque<Pose3> history{};  ///< True poses of the body after each step of a sweep, the newest last.
};

}  // namespace adit::sim
