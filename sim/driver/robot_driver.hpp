// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/exec/executor.hpp"
#include "core/wire/participant.hpp"
#include "robot_agent/motion/velocity_writer.hpp"
#include "sim/driver/sensor.hpp"
#include "sim/world/simulation.hpp"

namespace std_msgs::msg {
class Header;
}

namespace adit::sim {

struct DriverParams {
  Duration odom_period{20ms};   ///< (0, 1 s]
  Duration battery_period{1s};  ///< (0, 60 s]
  Duration scan_delay{20ms};    ///< Delay of a scan's sample in rehearsal, (0, 100 ms].
  Duration first_scan{100ms};   ///< Time of the first scan, which spreads the robots' scans, > 0.
  double charge{1.0};           ///< Charge of the battery at the start, [0, 1].
  double drain{1.0 / 14400.0};  ///< Charge that the battery loses a second, 1/s, [0, 1].
  agent::VelocityType velocity{agent::VelocityType::twist};  ///< Type of the /cmd_vel that it obeys.
  /// Called before odometry and scans are taken: a live world catches up with the clock that stamps them. May
  /// be empty.
  std::function<void()> catch_up{};
};

/// A simulated robot's driver: obeys rt/cmd_vel and gives rt/odom, rt/points and rt/battery_state, in a
/// realistic simulation also rt/imu/data, as a ROS 2 driver does. There its sensors' clocks differ by up to
/// 5 ms, and some samples come late or overtake others. Cameras send while they have a reader; without one
/// they cost nothing. The same code on the in-memory wire and on Fast DDS.
/// All drivers of one simulation live on strands of one thread.
class RobotDriver {
 public:
  /// `strand`, `wire` (the robot domain) and `simulation` outlive the driver.
  RobotDriver(Simulation& simulation, std::size_t robot, Executor& strand, wire::Participant& wire,
              const DriverParams& params);
  ~RobotDriver();
  /// Makes the endpoints and begins to send. Errors of the wire.
  Result<void> start();
  /// A sensor is silent as long as it was silenced more often than not.
  void silence(Sensor sensor, bool silent) { faults(sensor).silences += silent ? 1 : -1; }
  /// The stamps of a sensor are `by` off from now on; jumps add up, and the opposite one ends it. Its
  /// messages come at the same time as before.
  void jump_clock(Sensor sensor, Duration by) { faults(sensor).clock += by; }
  /// The stamps of a sensor are 0 as long as this began more often than it ended.
  void drop_stamps(Sensor sensor, bool begins) { faults(sensor).stampless += begins ? 1 : -1; }
  /// Realistic: columns of sweeps are lost; of several losses the newest counts.
  void lose_columns(const ColumnLoss& loss, bool begins);
  /// Realistic: the lidar is covered, see SweepJob.
  void cover(bool begins) { covers_ += begins ? 1 : -1; }
  /// The JPEGs of all cameras end in their middle as long as this began more often than it ended.
  void break_jpegs(bool begins) { broken_jpegs_ += begins ? 1 : -1; }

 private:
  struct Endpoints;
  struct Cameras;
  /// Faults of one sensor that are active.
  struct SensorFaults {
    int silences{}, stampless{};
    Duration clock{};
  };
  SensorFaults& faults(Sensor sensor) { return faults_[static_cast<std::size_t>(sensor)]; }
  bool silent(Sensor sensor) { return faults(sensor).silences > 0; }
  /// Header of a sensor's message that a driver without faults would stamp with `stamp`.
  std_msgs::msg::Header header(Sensor sensor, Time stamp, const std::string& frame);
  Result<void> listen();
  /// The driver's clock when the simulation was at `at`.
  Time simulated(Duration at);
  void send_odom();
  void send_imu();
  void send_battery();
  void send_points();
  void send_sweep(std::size_t lidar);
  Result<void> start_cameras();
  /// Takes a picture, unless nothing reads it or the one before is not ready yet.
  void send_picture(std::size_t camera);
  /// Writes a cloud of that lidar, unless the driver is gone by then.
  static std::function<void(const Result<std::vector<std::uint8_t>>&)> sender(std::weak_ptr<Endpoints> alive,
                                                                              std::size_t lidar);

  Simulation& simulation_;
  std::size_t robot_;
  Executor& strand_;
  wire::Participant& wire_;
  DriverParams params_;
  std::shared_ptr<Endpoints> endpoints_;  // shared with scans under way
  std::shared_ptr<Cameras> cameras_;      // shared with pictures under way; null: it has none
  Time started_{};
  std::array<SensorFaults, kSensors> faults_{};
  std::vector<ColumnLoss> losses_{};
  int covers_{}, broken_jpegs_{};
  double noise_;
  Random random_;                         ///< Of the timing.
  Time origin_{};                         ///< The driver's clock at the simulation's begin.
  Duration lidar_clock_{}, imu_clock_{};  ///< How far the sensors' clocks are ahead of the driver's.
  Time imu_waits_until_{};
  std::vector<Timer> late_{};  ///< Odometry that others overtake.
  Timer odom_{}, imu_{}, battery_{}, first_points_{}, points_{};
  std::vector<Timer> pictures_{};  ///< By camera.
};

}  // namespace adit::sim
