// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/component/call.hpp"
#include "core/component/component.hpp"
#include "core/config/platform.hpp"
#include "core/geometry/pose.hpp"
#include "perception/input/scan_input.hpp"
#include "perception/odometry/lidar_odometry.hpp"
#include "robot_agent/motion/input_faults.hpp"
#include "robot_agent/motion/motion_bound.hpp"
#include "robot_agent/motion/pose_correction.hpp"
#include "robot_agent/motion/pose_history.hpp"
#include "robot_agent/motion/static_frames.hpp"

namespace sensor_msgs::msg {
class Imu;
class LaserScan;
class PointCloud2;
}  // namespace sensor_msgs::msg
namespace nav_msgs::msg {
class Odometry;
}
namespace tf2_msgs::msg {
class TFMessage;
}

namespace adit::agent {

/// One scan of all lidars.
struct LidarScan {
  std::shared_ptr<PointCloud> points{};  ///< In the frame of base_link at `stamp`, m.
  std::uint64_t stamp{};                 ///< The instant of all points, driver's clock, ns.
  /// R_level_base: roll and pitch by the IMU. Nothing: they are the odometry's.
  std::optional<Eigen::Quaterniond> attitude{};
  Time received{};  ///< When the sample arrived, by our clock.
  /// With `perception: odometry` and higher.
  std::optional<OdometryReport> odometry{};
  bool planar{false};                    ///< See perception::Scan::planar.
  std::vector<std::uint8_t> isolated{};  ///< See perception::Scan::isolated.
  std::vector<ScanPart> parts{};         ///< See perception::Scan::parts.
};
/// Takes scans; offered by the component that uses them.
using ScanService = Service<LidarScan, void>;

/// The place of a robot that was lost, as it was found by other means.
struct FoundPlace {
  std::uint32_t instance{};  ///< Of the odometry.
  /// OdometryReport::steps of the pose that was compared; nothing: it holds for every pose.
  std::optional<std::uint32_t> steps{};
  /// From where it believed to be to where it is, in the odometry's own frame; keeps the vertical.
  Pose3 correction{};
  double sigma{}, sigma_heading{};  ///< Standard deviations of the corrected pose, m and rad.
};
/// Moves the robot's own odometry; offered by Scans. Returns OdometryReport::steps from then on. Error:
/// cancelled when it is another instance by now, or its pose stepped since.
using FoundPlaceService = Service<FoundPlace, std::uint32_t>;

/// Turns what the sensors send into scans (perception/input), on a strand of its own, so that they never
/// delay the command strand.
///
/// A message that cannot be used is refused with a reason (InputFaults). Nothing of it is passed on, so the
/// terrain is no longer fresh after half a second and autonomous modes stand.
class Scans : public Component {
 public:
  using Report = std::function<void(const InputFault&)>;

  /// `instance`: number of this instance since the start of the agent, from 1; 0: without odometry of its
  /// own.
  /// `frames`: those that came before.
  Scans(Executor& strand, Log log, const Platform& platform, const ScanService& output, Report report,
        const std::vector<StaticFrames::Frame>& frames, std::uint32_t instance = 0,
        FoundPlaceService* found_place = nullptr);

  /// On its strand; nothing when it does not run. `lidar`: index of Platform::all_lidars().
  void take(const sensor_msgs::msg::PointCloud2& cloud, std::size_t lidar, Time received);
  void take(const sensor_msgs::msg::LaserScan& scan, Time received);
  void take(const sensor_msgs::msg::Imu& imu, Time received);
  void take(const nav_msgs::msg::Odometry& odometry, Time received);
  void take(const tf2_msgs::msg::TFMessage& transforms, Time received);
  /// Two participants send the topic.
  void two_sources(const std::string& topic, const OneSource& source);

 protected:
  Result<void> on_start() override;

 private:
  struct Waiting {
    perception::Sweep sweep{};
    std::uint64_t end{};  ///< Of the sweep, ns.
    double ahead{};       ///< How far it ended after the newest odometry when it came, s.
    std::string frame{};
    Time received{};
  };
  void take(Result<perception::Sweep> sweep, std::size_t lidar, const std::string& frame, Time received);
  /// Whether the next odometry brings the poses of the sweep's end.
  bool is_ahead(const Waiting& waiting) const;
  /// Passes on the sweeps that need not wait any more, in the order of their ends, the first lidar's last.
  void pass_on_ready();
  bool must_wait(const std::deque<Waiting>& sweeps) const;
  void pass_on(std::size_t lidar, const Waiting& waiting);
  /// Moves the odometry to the end of a sweep of the first lidar; makes it when it is the first sweep.
  bool advance_odometry(const Waiting& waiting);
  /// Where the scan was taken. With a clock of its own, the driver's newest pose stands for that of the
  /// scan's time, and the report is `weak` at best.
  std::optional<OdometryReport> locate(const perception::Scan& scan);
  void report_clock_steps();
  void refuse(const std::string& topic, const Error& error);
  void warn(const std::string& topic, const char* code, Reason reason, const std::string& text);
  /// Compares the end of a sweep of the first lidar, ns, and the time of the odometry that was heard with it.
  void compare_clocks(std::uint64_t end);
  /// Warns of scans that cannot be corrected for motion.
  void judge_clock(const Waiting& waiting, bool deskewed);

  std::vector<LidarConfig> lidars_;
  const ScanService& output_;
  Report report_;
  perception::ScanInput input_;
  PoseHistory history_{};
  Platform platform_;
  MotionBound bound_;
  std::optional<OdometrySample> newest_odometry_{};  ///< By the driver.
  std::uint32_t instance_;
  FoundPlaceService* found_place_;
  std::optional<perception::LidarOdometry> odometry_{};  ///< Made with the first sweep.
  perception::LidarOdometry::ClockSteps clock_steps_{};  ///< Those that were reported.
  std::vector<std::deque<Waiting>> waiting_;             ///< For odometry as new as the sweep, by lidar.
  bool in_g_reported_{false};
  int not_deskewed_{0};  ///< Consecutive scans that were not corrected for motion, or of another clock.
  Time odometry_heard_{};
  /// How far the newest sweep ends after the newest odometry, s. Nothing: that is not heard.
  std::optional<double> ahead_{};
  double early_{};  ///< How far sweeps end after they come, s; 0 with one clock.
  int apart_{0};  ///< Consecutive sweeps that are of another time than the odometry that was heard with them.
  std::optional<Time> frame_unknown_{};  ///< When the frame of a message was unknown first.
};

/// The points of a cloud that has float32 x, y and z, in its frame. `duration`: of a sweep, s.
/// Errors: malformed when the layout does not fit the data; sensor_times.
Result<perception::Sweep> to_sweep(const sensor_msgs::msg::PointCloud2& cloud, double duration);
/// The points of a planar scan, at `height` (m) in its frame; what met nothing, or is out of the scanner's
/// range, is left out. `duration`: of a sweep, s. Errors: malformed when its angles are no numbers or turn
/// more than once; sensor_times when its rays take longer than a sweep.
Result<perception::Sweep> to_sweep(const sensor_msgs::msg::LaserScan& scan, double height, double duration);

}  // namespace adit::agent
