// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <deque>
#include <optional>

#include "core/geometry/pose.hpp"
#include "core/result/result.hpp"
#include "perception/odometry/motion_state.hpp"
#include "perception/odometry/sample_queue.hpp"
#include "perception/odometry/slip_watch.hpp"

namespace adit::perception {

/// Parameters of MotionFilter: the body's drive, and the errors of its sensors of motion. Defaults: a good
/// MEMS sensor on a vibrating drive, and worn wheels.
struct MotionParams {
  bool has_imu{true};
  bool has_wheels{true};                  ///< Or legs, or another source of BodyMotion.
  bool sideways{false};                   ///< It also moves sideways; else its sideways speed is about zero.
  bool flies{false};                      ///< It also moves up and down.
  Eigen::Vector3d imu_position{0, 0, 0};  ///< In base_link, m.
  double gyro_noise{0.002};               ///< White noise, rad/s/sqrt(Hz), (0, 1].
  double accel_noise{0.05};               ///< White noise, m/s2/sqrt(Hz), (0, 10].
  double gyro_walk{2e-5};                 ///< Random walk of the bias, rad/s/sqrt(s), [0, 1].
  double accel_walk{5e-4};                ///< Random walk of the bias, m/s2/sqrt(s), [0, 1].
  double gyro_bias{0.005};            ///< Standard deviation of the bias at a start in motion, rad/s, (0, 1].
  double accel_bias{0.06};            ///< Standard deviation of the bias at the start, m/s2, (0, 10].
  double gyro_scale{0.003};           ///< Standard deviation of the scale of a turn rate, (0, 0.5].
  double wheel_scale{0.02};           ///< Standard deviation of the wheels' scale at the start, (0, 0.5].
  double wheel_slip{0.03};            ///< Standard deviation of a speed by the wheels, share, (0, 1].
  double max_speed{2.0};              ///< m/s, (0, 100].
  double max_turn{2.0};               ///< rad/s, (0, 100].
  double max_acceleration{3.0};       ///< Of a body without IMU and wheels, m/s2, (0, 100].
  double max_turn_acceleration{3.0};  ///< The same, rad/s2, (0, 100].
};

/// Carries a body's state from sensor to sensor: an error-state Kalman filter (Sola 2017).
///
/// The IMU moves the state; where it is missing or has a gap, the wheels do, and without both the body keeps
/// its velocity. With an IMU, the speed by the wheels corrects the velocity, unless it contradicts it (slip),
/// and a body at rest has no velocity. Samples may come in any order; advance() uses those up to its stamp.
class MotionFilter {
 public:
  static constexpr std::uint64_t kHistory = 600'000'000;           ///< Of at(), ns.
  static constexpr std::uint64_t kMaxExtrapolation = 300'000'000;  ///< Of at(), ns.

  explicit MotionFilter(const MotionParams& params) : params_(params) {}

  /// Begins at a pose of base_link (odom). `gyro_bias`: as measured at rest; `tilt_sigma`: of roll and pitch,
  /// rad.
  void start(std::uint64_t stamp, const Pose3& T_odom_base, const Eigen::Vector3d& gyro_bias, bool at_rest,
             double tilt_sigma);
  bool started() const { return state_.stamp != 0; }

  /// A sample in the axes of base_link.
  void add(const ImuSample& sample) { imu_.add(sample); }
  void add(const BodyMotion& sample);
  /// Whether the sensors of motion were heard up to `stamp`, as far as they share its clock.
  bool covers(std::uint64_t stamp) const;

  /// Moves the state to `stamp`, with all samples until then, in a bounded number of steps.
  ///
  /// A stamp that is not of the clock of the one before does nothing, and the result is false. When the next
  /// one is of its clock, the clock was set: the state stands at its pose at the new stamp, with what the
  /// body may have done meanwhile in its covariance.
  bool advance(std::uint64_t stamp);
  /// T_odom_base on the way, extrapolated for a short time. Errors: out_of_range.
  Result<Pose3> at(std::uint64_t stamp) const;
  /// Replaces the state by its correction at the same stamp. One that is no number, or has a covariance that
  /// is none, is refused: the pose stays, and is known as badly as after a step of the clock.
  void correct(const MotionState& state);

  /// Without IMU and wheels: what the body is assumed to keep. In odom, m/s; body axes, rad/s.
  void set_rates(const Eigen::Vector3d& velocity, const Eigen::Vector3d& turn_rate) {
    state_.velocity = velocity;
    gyro_ = turn_rate;
  }
  /// The frame of the wheels began again elsewhere.
  void forget_wheels() { wheels_.clear(); }

  const MotionState& state() const { return state_; }
  Pose3 pose() const { return base_pose(state_); }
  /// Of base_link, in odom, m/s.
  Eigen::Vector3d velocity() const;
  /// How often the clock was set: of the stamps of advance(), of IMU and wheels.
  int clock_steps() const { return clock_steps_; }
  int imu_clock_steps() const { return imu_.clock_steps(); }
  int wheel_clock_steps() const { return wheels_.clock_steps(); }
  /// For how long no sensor of motion has moved the state, s.
  double free_for() const { return free_for_; }
  /// The body is at rest, by its wheels and its gyro.
  bool at_rest() const { return still_for_ > 0.3; }
  /// The lidar says that since the last call the wheels alone moved the state wrongly by `off` (odom, m; 0
  /// along directions that it does not determine). `by_lidar`, `by_wheels`: variances of the two ways, m2.
  void compare_wheels(const Eigen::Vector3d& off, double by_lidar, double by_wheels);
  /// The wheels contradict the IMU or the lidar: their speed counts no more than the contradiction allows,
  /// until both agree for a second.
  bool wheels_slip() const { return slip_.slipping(); }
  /// It lasts for longer than half a second.
  bool wheels_slip_lasts() const { return slip_.lasts(); }
  /// Whether the scale of the wheels may be learned now: the lidar determines the direction of travel.
  void learn_scale(bool learn) { learn_scale_ = learn; }
  const MotionParams& params() const { return params_; }

 private:
  struct Stamped {
    std::uint64_t stamp{};
    Pose3 pose{};
  };
  Pose3 base_pose(const MotionState& state) const;
  /// Moves the state to `stamp`, at most a few milliseconds on.
  void step(std::uint64_t stamp);
  void step_by_imu(double dt, const ImuSample& mean);
  void step_by_wheels(double dt, const Pose3& from, const Pose3& to);
  void step_free(double dt);
  /// Moves the covariance to the state.
  void propagate_covariance();
  /// Whether sensors of motion went on until `stamp`, over a silence of the lidar of any length.
  bool carried_to(std::uint64_t stamp) const;
  /// Adds what the body may have done within `unseen` (s).
  void widen(double unseen);
  /// The clock was set; the body moved for `unseen` (s) at most.
  void begin_again(std::uint64_t stamp, double unseen);
  void use_wheels(std::uint64_t from, std::uint64_t to);
  /// Corrects tilt and gravity by the roll and pitch that the driver's odometry states.
  void use_attitude();
  /// Corrects the state by three measured numbers. False, and nothing is done: farther than `gate` (squared
  /// standard deviations in any of them) from what is expected.
  bool update(const Eigen::Matrix<double, 3, MotionState::kSize>& H, const Eigen::Vector3d& residual,
              const Eigen::Vector3d& variance, double gate);

  MotionParams params_;
  MotionState state_{};
  bool learn_scale_{true};
  SampleQueue<ImuSample> imu_{};
  SampleQueue<BodyMotion> wheels_{};
  Eigen::Vector3d gyro_{0, 0, 0};  ///< Turn rate over the last step, body axes, rad/s.
  std::uint64_t wheels_used_{};    ///< Until then the wheels corrected the velocity.
  std::uint64_t attitude_used_{};  ///< Until then the driver's attitude corrected the tilt.
  bool leans_{};                   ///< The driver states roll and pitch; a planar one states zero.
  double still_for_{};             ///< s
  SlipWatch slip_{};
  double unseen_for_{};      ///< By wheels alone since the lidar last saw the way, s.
  double rolled_for_{};      ///< By wheels alone since compare_wheels(), s.
  double free_for_{};        ///< s
  double period_{};          ///< Between the last two stamps of advance(), s.
  std::uint64_t suspect_{};  ///< A stamp of advance() that was of another clock; 0: none.
  int clock_steps_{};
  /// The motion by which the covariance has not been moved yet.
  struct Pending {
    double dt{}, rolled_dt{}, free_dt{};  ///< By IMU, by wheels, by neither, s.
    Eigen::Quaterniond rotation{Eigen::Quaterniond::Identity()};
    Eigen::Vector3d velocity{0, 0, 0};  ///< Change of the velocity by the specific force, body axes at first.
    Eigen::Vector3d rolled{0, 0, 0};    ///< Way by the wheels, body axes at first.
    double turned{}, way{};
  } pending_{};
  std::deque<Stamped> history_{};
};

/// The covariance P after a cloud with `information` on the pose (as Registered::information), by a form that
/// stays positive: (P^-1 + I)^-1. `learn_scale`: also of the wheels' scale.
MotionState::Matrix after_registration(const MotionState::Matrix& P,
                                       const Eigen::Matrix<double, 6, 6>& information, bool learn_scale);

}  // namespace adit::perception
