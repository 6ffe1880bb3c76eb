// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "core/geometry/pose.hpp"
#include "perception/types/imu_sample.hpp"
#include "perception/types/sweep.hpp"
#include "sim/drive/drive_spec.hpp"

namespace adit::sim {

/// The true pose of base_link in the world.
struct TruthSample {
  std::uint64_t stamp{};  ///< ns
  Pose3 pose{};
};

/// What the robot's own odometry measured with wheels or legs.
struct WheelSample {
  std::uint64_t stamp{};  ///< ns
  Pose3 pose{};           ///< Of base_link in the odometry's frame, which begins at the start pose.
  OdometrySigma sigma{};  ///< As its driver states them.
};

/// Receives what a drive produces, in the order of time: a sweep comes when its last column was measured.
class DriveSink {
 public:
  virtual ~DriveSink() = default;
  virtual void on_imu(const perception::ImuSample& sample) = 0;
  virtual void on_wheels(const WheelSample& sample) = 0;
  /// Its stamp is that of the first column.
  virtual void on_sweep(perception::Sweep&& sweep) = 0;
  /// Every 10 ms, before the sensor data of that instant.
  virtual void on_truth(const TruthSample& truth) = 0;
};

/// Sensor data and truth of one drive. Stamps are on the driver's clock, but those of lidar and IMU are off
/// by a constant of up to 5 ms, as on a robot (with `noise` 1).
struct DriveRecording : DriveSink {
  std::vector<perception::Sweep> sweeps{};
  std::vector<perception::ImuSample> imu{};
  std::vector<WheelSample> wheels{};
  std::vector<TruthSample> truth{};  ///< Every 10 ms.

  /// Hands everything on again, in the order in which it was recorded but for ties.
  void play(DriveSink& sink) const;
  /// True pose at `stamp`, interpolated; the first or last one beyond the ends. There must be one.
  Pose3 truth_at(std::uint64_t stamp) const;
  /// Length of the true path of base_link, m.
  double distance() const;

  void on_imu(const perception::ImuSample& sample) override { imu.push_back(sample); }
  void on_wheels(const WheelSample& sample) override { wheels.push_back(sample); }
  void on_sweep(perception::Sweep&& sweep) override { sweeps.push_back(std::move(sweep)); }
  void on_truth(const TruthSample& pose) override { truth.push_back(pose); }

  /// When a sweep was complete, ns: the time of its last point.
  static std::uint64_t end_of(const perception::Sweep& sweep);
};

/// Stamp of the beginning of every drive, ns.
inline constexpr std::uint64_t kDriveStart = 1'000'000'000'000;

/// Drives and hands everything to `sink`, without storing it: a full sweep takes 0.4 MB. The same
/// specification gives the same data on every machine. Reason::bad_argument when the robot cannot start,
/// touches the world or a robot, or gets no farther.
Result<void> drive(const DriveSpec& spec, DriveSink& sink);

/// The same, in memory.
Result<DriveRecording> record_drive(const DriveSpec& spec);

}  // namespace adit::sim
