// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "perception/types/body_motion.hpp"
#include "perception/types/imu_sample.hpp"
#include "sim/cloud/cloud_file.hpp"
#include "sim/cloud/tum_file.hpp"

namespace adit::sim::perctool {

/// Stamp of the first cloud of a folder, ns; those of IMU and wheels count from it, too.
inline constexpr std::uint64_t kLogStart = 1'000'000'000'000;

/// Receives recorded sensor data in the order of time.
class SensorSink {
 public:
  virtual ~SensorSink() = default;
  virtual void on_imu(const perception::ImuSample& sample) = 0;  ///< In the IMU's axes.
  virtual void on_wheels(const perception::BodyMotion& sample) = 0;
  virtual Result<void> on_sweep(perception::Sweep&& sweep) = 0;     ///< In the lidar's frame.
  virtual void on_truth(const StampedPose& truth) { (void)truth; }  ///< Of base_link, world.
};

struct SensorLogOptions {
  std::string clouds{};  ///< File, folder, or an MCAP file of `perctool record`.
  double rate{10.0};     ///< Clouds of a folder a second, Hz, (0, 100].
  std::string imu{};     ///< CSV: stamp_s,gx,gy,gz,ax,ay,az (rad/s, m/s2), with or without a header line.
  std::string wheels{};  ///< TUM.
};

/// IMU samples of a CSV file. Errors name file and line: Reason::cannot_read, syntax.
Result<std::vector<perception::ImuSample>> read_imu_csv(const std::filesystem::path& file);

/// Whether it is an MCAP file, which has IMU and wheels in it.
bool is_mcap(const std::string& file);

/// Plays everything into `sink`. The stamps of IMU and wheels are those of the clouds' clock: s since the
/// first cloud. Errors: those of the files and of the sink.
Result<void> play_log(const SensorLogOptions& options, SensorSink& sink);

/// The same of an MCAP file alone, as `perctool record` writes it.
Result<void> play_mcap(const std::string& file, SensorSink& sink);

/// The `sensors:` part of the platform's file that such an MCAP file has in it; empty: none.
Result<std::string> recorded_sensors(const std::string& file);

}  // namespace adit::sim::perctool
