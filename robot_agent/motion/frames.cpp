// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/motion/frames.hpp"

#include <cmath>

namespace adit::agent {
namespace {

/// Maximum time that a body keeps driving after an odometry sample: the agent detects after kAlive that
/// there is no other one, and the driver receives zero within 250 ms of that.
constexpr Duration kMaxDriveWithoutOdometry = Frames::kAlive + 250ms;
/// The same for a sample that was stored before a restart of the agent. It is stored once a second, and the
/// parent process sends zero within 250 ms of the agent's end.
constexpr Duration kMaxDriveOverRestart = kMaxDriveWithoutOdometry + 1250ms;

// A few consecutive samples with stamps slightly before the newest one arrived out of order. More of them, or
// older ones, show that the driver's clock was set back.
constexpr std::uint64_t kMaxReorderingDelay = 500'000'000;  ///< ns
constexpr int kMaxConsecutiveLate = 3;

constexpr double kMaxTilt = 0.02;  ///< Tilt up to which a correction counts as level, rad.

}  // namespace

bool Frames::is_late(std::uint64_t stamp) const {
  const std::uint64_t newest = history_.newest();
  return stamp != 0 && stamp < newest && newest - stamp <= kMaxReorderingDelay;
}

bool Frames::is_reachable(const OdometrySample& sample, bool late) const {
  if (!newest_) return true;
  const Duration max_drive = received_at_ ? kMaxDriveWithoutOdometry : kMaxDriveOverRestart;
  // A late sample was measured before the newest one.
  if (late) return bound_.reachable(sample, *newest_, max_drive);
  return bound_.reachable(*newest_, sample, max_drive);
}

bool Frames::update(const Pose3& T_odom_base, const Twist2& twist, std::uint64_t stamp, Time now) {
  const OdometrySample sample{T_odom_base, stamp, now};
  consecutive_late_ = is_late(stamp) ? consecutive_late_ + 1 : 0;
  const bool late = consecutive_late_ > 0 && consecutive_late_ <= kMaxConsecutiveLate;
  const bool continuous = is_reachable(sample, late);
  received_at_ = now;
  if (late && continuous) {
    history_.add(stamp, T_odom_base);
    return true;
  }
  if (!continuous) begin_odometry_frame(sample);
  if (stamp < history_.newest()) history_.clear();  // The driver's clock was set back.
  history_.add(stamp, T_odom_base);
  newest_ = sample;
  twist_ = twist;
  consecutive_late_ = 0;
  return continuous;
}

// The odometry began again elsewhere, for example at a restart of the driver. The robot is still where it
// was: its pose in the map, T_map_base, is preserved, and T_map_odom is computed for the new odometry frame.
// All stored coordinates in `odom` become invalid.
void Frames::begin_odometry_frame(const OdometrySample& sample) {
  T_map_odom_ = T_map_base() * sample.T_odom_base.planar().inverse();
  height_ = height() - sample.T_odom_base.position.z();
  ++odom_epoch_;
  ++map_epoch_;
  history_.clear();
}

Result<void> Frames::correct(const MapFrame& corrected) {
  if (corrected.odom_epoch != odom_epoch_)
    return {Reason::odometry_jumped, "the correction is for a previous odometry frame"};
  if (corrected.map_epoch != map_epoch_)
    return {Reason::sample_stale, "the correction was computed from an outdated T_map_odom"};
  const Pose3& T_map_odom = corrected.T_map_odom;
  const Eigen::Quaterniond& q = T_map_odom.orientation;
  const bool is_pose = T_map_odom.position.allFinite() && std::fabs(q.norm() - 1.0) < 1e-3;
  // The comparison is negated, so that a tilt of NaN is refused.
  if (!is_pose || !((q * Eigen::Vector3d::UnitZ()).head<2>().norm() <= std::sin(kMaxTilt)))
    return {Reason::out_of_range,
            "the correction is not finite, not a rotation, or tilted by more than 0.02 rad"};
  T_map_odom_ = T_map_odom.planar();
  height_ = T_map_odom.position.z();
  ++map_epoch_;
  return {};
}

void Frames::set_pose(const Pose2& T_map_base) {
  T_map_odom_ = T_map_base * T_odom_base().planar().inverse();
  ++map_epoch_;
}

void Frames::restore(const StoredFrames& stored) {
  T_map_odom_ = stored.T_map_odom;
  height_ = stored.height.value_or(height_);
  odom_epoch_ = stored.odom_epoch;
  newest_ = stored.newest;
  map_epoch_ = stored.map_epoch + 1;
}

const Pose3& Frames::T_odom_base() const {
  static const Pose3 origin{};
  return newest_ ? newest_->T_odom_base : origin;
}

Eigen::Vector3d Frames::to_odom(const Eigen::Vector3d& in_map) const {
  const Eigen::Vector2d planar = to_odom(Eigen::Vector2d(in_map.head<2>()));
  return {planar.x(), planar.y(), in_map.z() - height_};
}

Eigen::Vector3d Frames::to_map(const Eigen::Vector3d& in_odom) const {
  const Eigen::Vector2d planar = T_map_odom_ * Eigen::Vector2d(in_odom.head<2>());
  return {planar.x(), planar.y(), in_odom.z() + height_};
}

}  // namespace adit::agent
