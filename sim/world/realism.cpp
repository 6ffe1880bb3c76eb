// SPDX-License-Identifier: Apache-2.0
#include "sim/world/realism.hpp"

#include <algorithm>

#include "sim/world/mount_error.hpp"

namespace adit::sim {
namespace {

constexpr double kImuHeight = 0.2;   // m
constexpr double kFastestImu = 400;  // Hz
constexpr double kLidarBias = 0.01;  // m: largest error common to all ranges

ImuParams of_platform(ImuParams params, const Platform& platform) {
  if (platform.imu) params.rate = std::min(kFastestImu, platform.imu->rate);
  // Tracks shake more than wheels.
  if (platform.drive != Drive::tracked) return params;
  params.accel_vibration *= 2.0;
  params.gyro_vibration *= 2.0;
  return params;
}

Pose3 nominal_imu(const Platform& platform) {
  if (platform.imu) return platform.imu->mounting.pose();
  return {{0.0, 0.0, kImuHeight}, Eigen::Quaterniond::Identity()};
}

Pose3 true_lidar(const Pose3& nominal, double noise, std::uint64_t seed) {
  Random random(seed);
  return nominal * mount_error(random, noise * kMountOffset, noise * kMountAngle);
}

}  // namespace

Realism::Realism(const Platform& platform, const ImuParams& imu_params, double noise, std::uint64_t seed)
    : chassis(platform),
      imu(of_platform(imu_params, platform), nominal_imu(platform), noise, derive_seed(seed, 1)) {
  for (const LidarConfig& config : platform.all_lidars()) {
    const std::uint64_t part = 2 * lidars.size() + 2;
    MountedLidar& lidar = lidars.emplace_back();
    lidar.T_base_lidar = true_lidar(config.mounting.pose(), noise, derive_seed(seed, part));
    lidar.errors.noise = noise;
    lidar.errors.bias = Random(derive_seed(seed, part + 1)).uniform(-kLidarBias, kLidarBias);
  }
}

}  // namespace adit::sim
