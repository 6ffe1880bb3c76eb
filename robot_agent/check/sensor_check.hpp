// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/config/platform.hpp"
#include "core/geometry/pose.hpp"
#include "core/time/time.hpp"
#include "perception/input/scan_input.hpp"
#include "perception/input/turn_check.hpp"
#include "robot_agent/check/config_lines.hpp"
#include "robot_agent/check/ground_fit.hpp"
#include "robot_agent/motion/charge_input.hpp"
#include "robot_agent/motion/sensor_readers.hpp"
#include "robot_agent/motion/topic_types.hpp"
#include "sensor_msgs/msg/BatteryState.h"

namespace adit::agent {

/// One line of the report of `robot_agent check`.
struct CheckLine {
  bool ok{};
  std::string what{};   ///< What was judged, for example "lidar /points: height".
  std::string found{};  ///< What was measured.
  std::string where{};  ///< The line of the file to change, "file:line", or a command; empty when it is OK.
};

/// Judges the sensors of a mounted robot by what their drivers send while the robot stands and then turns.
class SensorCheck {
 public:
  SensorCheck(const Platform& platform, ConfigLines lines);

  void take(const sensor_msgs::msg::PointCloud2& cloud, std::size_t lidar, Time received);
  void take(const sensor_msgs::msg::LaserScan& scan, Time received);
  void take(const sensor_msgs::msg::Imu& imu, Time received);
  void take(const nav_msgs::msg::Odometry& odometry, Time received);
  void take(const tf2_msgs::msg::TFMessage& transforms, Time received);
  void take(const sensor_msgs::msg::BatteryState& battery, const wire::ParticipantId& sender);
  /// Two participants send the topic.
  void two_sources(const std::string& topic, const OneSource& source);
  /// Looks at who reads and writes the topics, and with which types.
  void look(const wire::Participant& wire, VelocityType velocity);

  /// The robot no longer stands: from now on the gyro is compared with the odometry.
  void begin_turn() { turning_ = true; }
  /// The odometry has shown a quarter turn.
  bool turned() const { return turns_.ratio() != 0; }
  /// All lines; `turn`: whether a turn was asked for.
  std::vector<CheckLine> report(bool turn) const;

 private:
  /// What a topic's messages had in common.
  struct Stream {
    std::size_t count{};
    Time first{}, last{};
    double least_delay{}, most_delay{};           ///< Reception less stamp, s: of two clocks.
    std::map<std::string, std::size_t> frames{};  ///< At most kMaxFrames.
    std::string error{};                          ///< Of the newest message that could not be used.
    std::size_t unusable{};

    void note(std::uint64_t stamp, const std::string& frame, Time received);
    double rate() const;
  };
  struct Lidar {
    LidarConfig config{};
    Stream stream{};
    GroundFit ground{};
    bool planar{};
  };
  void take(const Result<perception::Sweep>& sweep, Lidar& lidar, const std::string& frame);
  void report_stream(const std::string& name, const Stream& stream, double rate,
                     const std::function<std::string(const std::string&)>& line,
                     std::vector<CheckLine>& out) const;
  void report_ground(const Lidar& lidar, std::size_t n, std::vector<CheckLine>& out) const;
  void report_imu(std::vector<CheckLine>& out) const;
  void report_turn(std::vector<CheckLine>& out) const;

  Platform platform_;
  ConfigLines lines_;
  perception::ScanInput input_;
  std::vector<Lidar> lidars_{};
  Stream imu_{}, odometry_{};
  ChargeInput charge_{};
  std::optional<CheckLine> battery_{};              ///< By its newest message; one that is wrong stays.
  std::map<std::string, CheckLine> two_sources_{};  ///< By topic.
  std::vector<CheckLine> topics_{};
  bool turning_{false};
  Eigen::Vector3d force_{0, 0, 0}, gyro_{0, 0, 0};  ///< Sums while standing, base_link.
  std::size_t standing_{};                          ///< Samples in them.
  double about_z_{}, about_all_{};                  ///< Sums of turn rates while turning, rad/s.
  perception::TurnCheck turns_{};
};

/// Whether the kernel grants the receive buffer that scans need. `granted`: net.core.rmem_max, bytes.
CheckLine judge_buffer(std::uint64_t granted);
/// The report as text, one line each; lines that are wrong name what to change.
std::string to_text(const std::vector<CheckLine>& lines);

}  // namespace adit::agent
