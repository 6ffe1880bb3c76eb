// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/motion/frames.hpp"

#include <cmath>
#include <utility>

namespace adit::agent {
namespace {

/// Maximum time that a body drives after an odometry sample: until the agent sends zero, or its parent
/// process does. A sample stored over a restart is up to 1 s older than the end of the agent.
constexpr Duration kUnwatched = Frames::kAlive + 250ms, kRestart = kUnwatched + 1250ms;

// A few consecutive samples that are slightly older than the newest one were overtaken on their path. More
// samples, or older ones, show that the driver's clock was set back.
constexpr std::uint64_t kLongestDelay = 500'000'000;  // Maximum delay of an overtaken sample, ns.
constexpr int kMostOvertaken = 3;                     // Maximum number of consecutive overtaken samples.

constexpr double kLevel = 0.02;  // Tilt, rad.

}  // namespace

bool Frames::overtaken(std::uint64_t stamp) {
  const std::uint64_t newest = history_.newest();
  const bool late = stamp != 0 && stamp < newest && newest - stamp <= kLongestDelay;
  overtaken_ = late ? overtaken_ + 1 : 0;
  return late && overtaken_ <= kMostOvertaken;
}

bool Frames::update(const Pose3& T_odom_base, const Twist2& twist, std::uint64_t stamp, Time now) {
  const OdometrySample sample{T_odom_base, stamp, now};
  const Duration unwatched = heard_ ? kUnwatched : kRestart;
  const bool late = overtaken(stamp);
  const bool continuous = !newest_ || (late ? bound_.reachable(sample, *newest_, unwatched)
                                            : bound_.reachable(*newest_, sample, unwatched));
  heard_ = now;
  if (late && continuous) {
    history_.add(stamp, T_odom_base);
    return true;
  }
  if (!continuous) jump(sample);
  if (stamp < history_.newest()) history_.clear();  // The driver's clock was set back.
  history_.add(stamp, T_odom_base);
  newest_ = sample;
  twist_ = twist;
  overtaken_ = 0;
  return continuous;
}

void Frames::jump(const OdometrySample& sample) {
  T_map_odom_ = T_map_base() * sample.T_odom_base.planar().inverse();
  height_ = height() - sample.T_odom_base.position.z();
  ++odom_epoch_;
  ++map_epoch_;
  history_.clear();
}

Result<void> Frames::correct(const MapFrame& corrected) {
  if (corrected.odom_epoch != odom_epoch_)
    return {Reason::odometry_jumped, "the correction is of an odometry frame that ended"};
  if (corrected.map_epoch != map_epoch_)
    return {Reason::sample_stale, "the correction was computed from a place of the map that has changed"};
  const Pose3& T_map_odom = corrected.T_map_odom;
  const Eigen::Quaterniond& q = T_map_odom.orientation;
  const bool is_pose = T_map_odom.position.allFinite() && std::fabs(q.norm() - 1.0) < 1e-3;
  // Negated, so that NaN is rejected.
  if (!is_pose || !((q * Eigen::Vector3d::UnitZ()).head<2>().norm() <= std::sin(kLevel)))
    return {Reason::out_of_range, "map and odom are level, and a correction is finite"};
  T_map_odom_ = T_map_odom.planar();
  height_ = T_map_odom.position.z();
  ++map_epoch_;
  return {};
}

void Frames::set_pose(const Pose2& T_map_base) {
  T_map_odom_ = T_map_base * T_odom_base().planar().inverse();
  ++map_epoch_;
}

void Frames::restore(const KeptPlace& kept) {
  T_map_odom_ = kept.T_map_odom;
  height_ = kept.height.value_or(height_);
  odom_epoch_ = kept.odom_epoch;
  newest_ = kept.newest;
  map_epoch_ = kept.map_epoch + 1;
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

Result<Pose3> Frames::T_map_base_at(std::uint64_t stamp) const {
  auto T_odom_base = T_odom_base_at(stamp);
  if (!T_odom_base) return T_odom_base;
  return Pose3::level(T_map_odom_, height_) * *T_odom_base;
}

}  // namespace adit::agent
