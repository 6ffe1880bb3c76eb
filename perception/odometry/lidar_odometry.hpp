// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/config/platform.hpp"
#include "perception/odometry/drift.hpp"
#include "perception/odometry/known_space.hpp"
#include "perception/odometry/motion_filter.hpp"
#include "perception/odometry/odometry_state.hpp"
#include "perception/odometry/registration.hpp"
#include "perception/odometry/start.hpp"
#include "perception/voxel/thin.hpp"
#include "perception/voxel/voxel_planes.hpp"

namespace adit::perception {

/// Parameters of LidarOdometry.
struct LidarOdometryParams {
  MotionParams motion{};
  RegistrationParams registration{};
  VoxelPlanes::Params map{};
  Thinner::Params dense{.wanted = 12000, .min_edge = 0.05f};  ///< Of the points that enter the map.
  Thinner::Params thin{};                                     ///< Of those that are compared with it.
  bool planar{false};  ///< One horizontal ring: walls count as vertical, and height and tilt are not seen.
  /// A point so far from its plane matches it at first, where sensors of motion predict the pose, m, (0, 1].
  double first_window{0.3};
  double max_speed{0.0};  ///< A body that is faster than 1.5 times this is lost, m/s; 0: no limit.

  /// For a robot; without a lidar's or an IMU's entry, standard ones. `wheels`: its driver sends odometry.
  static LidarOdometryParams of(const Platform& platform, bool wheels = true);
  /// For clouds alone, of a lidar whose noise is `noise`, m.
  static LidarOdometryParams clouds_only(double noise, double min_range, double max_range);
};

/// Lidar-inertial odometry: an error-state Kalman filter that IMU and wheels carry on, corrected by each
/// cloud on a map of planes (direct registration as in FAST-LIO2, Xu et al. 2022; planes in voxels as in
/// VoxelMap, Yuan et al. 2022), in which wheels rule the directions that the lidar does not determine.
///
/// Pure: samples and clouds in, poses out; no clock. A missing sensor only removes its term. Calls for each
/// cloud, in this order: advance() to its instant; at() for deskewing it; update().
class LidarOdometry {
 public:
  static constexpr double kMaxWindow = 1.0;  ///< A point farther from its plane never matches it, m.

  explicit LidarOdometry(const LidarOdometryParams& params);

  /// A sample in the axes of base_link, m/s2.
  void add(const ImuSample& sample);
  void add(const BodyMotion& sample);
  /// Whether the sensors of motion were heard up to `stamp`, as far as they speak at all.
  bool covers(std::uint64_t stamp) const { return filter_.covers(stamp); }

  /// Moves the state to `stamp`; false while it cannot start yet, and for a single stamp that is more than a
  /// second away from the others. See MotionFilter::advance() for a clock that was set.
  bool advance(std::uint64_t stamp);
  /// T_odom_base at a stamp of the last 0.6 s, or up to 0.3 s ahead. Errors: out_of_range.
  Result<Pose3> at(std::uint64_t stamp) const;
  /// Corrects the state by a cloud at the stamp of the last advance().
  ///
  /// @param points  In base_link at that instant, m.
  /// @param skipped  One per point, not 0: on something that moves, or no surface at all, as dust (see
  ///     Scan::isolated). Such a point is neither compared nor enters the map. Empty: none.
  /// @param deskewed  False: the points have no times, so that the cloud is distorted by the motion since the
  ///     last one. Planes across the motion then weigh less.
  const OdometryState& update(std::span<const Eigen::Vector3f> points,
                              std::span<const std::uint8_t> skipped = {}, bool deskewed = true);
  const OdometryState& state() const { return state_; }
  /// Samples beyond what a sensor can measure, or that are no numbers; none of them is used.
  std::uint64_t refused_samples() const { return refused_samples_; }
  /// Way of the body, of which what is shorter than the noise of standing does not count, m.
  double travelled() const { return travelled_; }
  /// How often each sensor's clock was set, or the sensor was silent for longer than a second.
  struct ClockSteps {
    int lidar{}, imu{}, wheels{};
  };
  ClockSteps clock_steps() const {
    return {filter_.clock_steps(), filter_.imu_clock_steps(), filter_.wheel_clock_steps()};
  }
  /// The body's place was found by other means, as its operator or a comparison with stored scans. Moves the
  /// frame, so that poses are `correction` times what they were; ends `lost` and `unplaced`.
  ///
  /// @param correction  In odom; it keeps the vertical.
  /// @param sigma       Standard deviations of the corrected pose: horizontally, m; of the heading, rad.
  /// @param steps       OdometryState::steps of the pose that was compared. When there was another step
  /// since,
  ///     nothing happens, and the result is false. Nothing: it holds for every pose.
  bool relocalised(const Pose3& correction, double sigma, double sigma_heading,
                   std::optional<std::uint32_t> steps = {});
  /// The wheels' frame began again elsewhere.
  void forget_wheels() { filter_.forget_wheels(); }

 private:
  bool start(std::uint64_t stamp);
  /// Of a cloud that is not deskewed.
  Smear smear() const;
  /// After a silence of the lidar: the window is as wide as the pose is uncertain.
  void widen_window();
  void apply(const Registered& found);
  void judge(const Registered& found);
  /// Compares the way of the wheels since the last cloud with the registered one.
  void compare_wheels(const Registered& found);
  /// The cloud does not fit, for so much longer, s.
  void miss(double dt);
  void begin_map();
  /// Compares the last cloud with the map before it was lost.
  void search_before();
  /// What the body may have done since the last cloud that fitted: standard deviations as in the covariance.
  Eigen::Matrix<double, 6, 1> doubt() const;
  void insert(std::span<const Eigen::Vector3f> points);
  void report();
  /// Turns the frame of the odometry slowly until gravity is vertical in it.
  void level(double dt);
  /// Frame in which the filter works to odom.
  Pose3 odom_pose(const Pose3& local) const { return T_odom_local_ * local; }

  static constexpr std::size_t kLeastMatches = 40;  ///< Points with a plane nearby; fewer say nothing.
  static constexpr int kBadForDoubt = 2;  ///< Clouds in a row that do not fit: more than an accident.
  /// What it knew before it was lost.
  struct Before {
    VoxelPlanes map;
    KnownSpace space;
    DriftAccount drift;
    int found{};  ///< Clouds in a row that fit it.
  };

  LidarOdometryParams params_;
  MotionFilter filter_;
  Registration registration_;
  VoxelPlanes map_;
  KnownSpace space_{};
  std::optional<Before> before_{};
  Thinner dense_, thinner_;
  StartWatch watch_{};
  DriftAccount drift_{};
  std::optional<BodyMotion> newest_wheels_{};
  Pose3 T_odom_local_{};
  OdometryState state_{};
  Eigen::Matrix<double, 6, 6> pose_covariance_{
      Eigen::Matrix<double, 6, 6>::Zero()};    ///< After the last cloud.
  std::optional<Pose3> last_pose_{};           ///< Of the last cloud, local.
  std::optional<Pose3> drift_pose_{};          ///< Until which the drift was accounted for, local.
  std::optional<Eigen::Vector3d> way_pose_{};  ///< Until which the way was counted, local.
  std::uint64_t refused_samples_{};
  double missed_for_{};  ///< Since the last cloud that fitted, s.
  bool established_{};   ///< Enough clouds have fitted for a map to be lost in.
  std::uint64_t last_stamp_{};
  std::optional<Pose3> inserted_at_{};
  std::uint64_t first_imu_wait_{};
  double travelled_{}, reach_{5.0}, window_{};
  int clouds_{}, bad_{}, good_{};
  std::vector<Eigen::Vector3f> body_points_{}, static_points_{};
  std::vector<Eigen::Vector3d> map_points_{};
};

}  // namespace adit::perception
