// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <limits>
#include <optional>

#include "core/config/perception_level.hpp"
#include "core/config/platform.hpp"
#include "core/geometry/pose.hpp"
#include "core/time/time.hpp"
#include "robot_agent/motion/motion_bound.hpp"

namespace adit::agent {

/// The result of the robot's own odometry for one scan.
struct OdometryReport {
  std::uint64_t stamp{};     ///< End of the sweep, driver's clock, ns.
  Pose3 T_local_base{};      ///< In the frame of this odometry.
  Pose3 T_local_driver{};    ///< The driver's odometry in that frame, so that both agree at `stamp`.
  std::uint32_t instance{};  ///< Of the odometry: another one has another frame.
  Localisation health{Localisation::starting};
  double sigma{};       ///< Standard deviation of the horizontal position since the odometry began, m.
  double sigma_seen{};  ///< See perception::OdometryState::sigma_seen, m.
  bool wheels_slip{};   ///< See perception::OdometryState.
  std::uint32_t relocalised{};  ///< The same.
  std::uint32_t steps{};        ///< The same.
};

/// The two poses of a robot in the frame `odom`, by its own odometry and its driver's.
///
/// located() is where the own odometry saw the body at a scan. It may jump; maps, keyframes and places use
/// it. apply() is for what controls the body: it has the driver's rate and delay, and never jumps. The
/// driver's odometry carries it between two scans, and goes on alone when the own odometry is silent; it
/// follows located() as fast as the body itself can move, so that wheels that turn while the body stands, or
/// in a turn that it does not make, cannot carry it away. What is not made up for yet is part of its error.
///
/// Where the driver's frame began again, or another instance of the odometry begins, the next report
/// continues from the present pose. An instance that begins while the robot is lost knows no more of the
/// place than the one before: whatever it says of itself, the robot stays lost until its place is found, or
/// set.
class PoseCorrection {
 public:
  static constexpr double kPending = 0.2;   ///< A larger correction that is pending is not `ok`, m.
  static constexpr Duration kSilence = 1s;  ///< After a longer silence the health is `starting`.

  explicit PoseCorrection(const Platform& platform)
      : max_speed_(MotionBound::kFaster * platform.max_speed),
        max_turn_(MotionBound::kFaster * platform.max_turn) {}

  /// What is known of the instance that reports, and of those before it; standard deviations in m.
  struct Account {
    std::uint32_t instance{};     ///< 0: none has reported.
    std::uint32_t relocalised{};  ///< Of its last report.
    std::uint32_t steps{};        ///< The same.
    bool lost{};                  ///< The last report, or `unplaced`.
    bool unplaced{};              ///< It began while the robot was lost, and its place was not found since.
    double before{};              ///< Of the pose when it began.
    double seen_before{};         ///< The same without what moved the body unseen until then.
    double from{};                ///< Of the reported one, from which on it counts.
    double seen{};                ///< See sigma_seen().
  };

  /// Continues with a stored correction after a restart. `sigma`: of the pose before it, m. `account`: as it
  /// was, where the odometry was not restarted.
  void restore(const Pose3& T_odom_driver, double sigma, const Account& account) {
    T_odom_driver_ = wanted_ = T_odom_driver;
    sigma_ = sigma;
    account_ = account;
    if (account.instance == 0) account_.before = account_.seen_before = account_.seen = sigma;
  }
  void restore(const Pose3& T_odom_driver, double sigma) { restore(T_odom_driver, sigma, Account()); }
  /// An operator said where the robot is: sigma counts from here on.
  void reset_sigma() {
    sigma_ = alone_ = account_.before = account_.seen_before = account_.seen = 0.0;
    account_.from = reported_;
    account_.lost = account_.unplaced = false;
  }
  /// Until the odometry knows of a pose that an operator set, it may still step to a place that it found
  /// before: its pose goes on from the present one after each step.
  void hold_steps() { holds_steps_until_ = std::numeric_limits<std::uint32_t>::max(); }
  /// It knows of it since so many steps; nothing: it does not answer.
  void release_steps(std::optional<std::uint32_t> steps) { holds_steps_until_ = steps; }
  /// The driver's frame began again; reports about scans before `stamp` are of the previous one.
  void begin_frame(std::uint64_t stamp);
  /// Moves the pose by `correction` in odom, as it was found by other means; level.
  void shift(const Pose3& correction);
  /// Takes a report. Ignored: one that is not finite, or of a previous frame.
  void take(const OdometryReport& report, Time now);
  /// T_odom_base for a pose of the driver. A step of the driver that no body makes passes unchanged.
  Pose3 apply(const Pose3& T_driver_base, std::uint64_t stamp);
  /// T_odom_base at the stamp of a report that was taken, as the own odometry saw it. Nothing: it has no
  /// frame yet, or was another instance's.
  std::optional<Pose3> located(const OdometryReport& report) const;
  /// How often located() jumped: poses before and after lie in one frame, but not one beside the other.
  std::uint32_t jumps() const { return jumps_; }

  /// Frame of the own odometry to odom, and its instance; nothing: see located().
  std::optional<Pose3> T_odom_local() const { return T_odom_local_; }
  std::uint32_t instance() const { return account_.instance; }
  std::uint32_t steps() const { return account_.steps; }

  const Pose3& T_odom_driver() const { return T_odom_driver_; }
  Localisation health(Time now) const;
  /// Whether the last report was of a robot that is lost.
  bool lost() const { return account_.lost; }
  const Account& account() const { return account_; }
  /// Standard deviation of the horizontal position when the lidar last saw something known, m.
  double sigma_seen() const { return account_.seen; }
  /// How far the body may have been moved since then, m.
  double moved() const;
  /// Standard deviation of the horizontal position, with what is not made up for, m.
  double sigma() const;

 private:
  /// The frame of the report begins at the present pose.
  void begin(const OdometryReport& report);

  double max_speed_, max_turn_;  ///< Of the body, in m/s and rad/s.
  Pose3 T_odom_driver_{}, wanted_{};
  std::optional<Pose3> T_odom_local_{};  ///< Nothing: the next report sets it.
  Account account_{};
  std::optional<std::uint32_t> holds_steps_until_{};
  std::uint32_t jumps_{};
  std::uint64_t frame_began_{}, applied_{}, reported_at_{};  ///< Stamps.
  std::optional<Pose3> T_driver_base_{}, T_odom_base_{};     ///< The newest ones.
  std::optional<Time> heard_{};
  Localisation health_{Localisation::starting};
  double sigma_{};     ///< Of the last report, m.
  double reported_{};  ///< The present instance's part of it, m.
  double pending_{};   ///< From apply() to where it should be, m.
  double slip_{};      ///< How fast the driver's odometry leaves the own one, m/s.
  /// Standard deviation of the way by the driver's odometry alone since the last report, m.
  double alone_{};
  bool slips_{};  ///< The wheels slipped at the last report.
};

}  // namespace adit::agent
