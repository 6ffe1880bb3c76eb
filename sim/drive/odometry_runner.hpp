// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <deque>
#include <functional>
#include <optional>
#include <string>

#include "core/config/platform.hpp"
#include "perception/input/scan_input.hpp"
#include "perception/odometry/lidar_odometry.hpp"
#include "perception/types/sweep.hpp"

namespace adit::sim {

/// Feeds recorded or simulated sensor data to the odometry as the agent does: a sweep waits until its sensors
/// of motion cover it, becomes a scan (perception::ScanInput), and corrects the pose. What the agent adds to
/// that, frames of /tf_static, several lidars and the pose that telemetry sends, is judged in rehearsals
/// (bench/perception/telemetry_rows.hpp).
class OdometryRunner {
 public:
  /// What became of one sweep.
  struct Step {
    const perception::Sweep& sweep;
    std::uint64_t end{};  ///< Instant of the pose, ns.
    bool located{};       ///< False while the odometry cannot start yet.
    const perception::OdometryState& state;
    double ms{};  ///< CPU time of this thread.
  };
  using OnStep = std::function<void(const Step&)>;

  /// `moves`: there are sensors of motion, for which sweeps wait.
  OdometryRunner(const Platform& platform, const perception::LidarOdometryParams& params, bool moves,
                 OnStep on_step);

  void add(const perception::ImuSample& sample);  ///< In the IMU's axes.
  void add(const perception::BodyMotion& sample);
  void add(perception::Sweep&& sweep);  ///< In the lidar's frame.
  /// Takes the sweeps that still wait.
  void finish();

 private:
  void work();
  void take();
  void correct(const perception::Sweep& sweep);

  std::string lidar_frame_;
  Eigen::Quaterniond R_base_imu_;
  bool moves_;
  OnStep on_step_;
  std::optional<perception::BodyMotion> last_motion_{};
  perception::ScanInput input_;
  perception::LidarOdometry odometry_;
  std::deque<perception::Sweep> waiting_{};
};

}  // namespace adit::sim
