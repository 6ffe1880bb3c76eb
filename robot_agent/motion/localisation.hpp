#pragma once
#include <array>
#include <optional>

#include "robot_agent/motion/motion_bound.hpp"

namespace adit::agent {

/// Where the robot is: the driver's odometry, placed in the map. The place of the odometry frame in the map
/// is the start pose, until the odometry jumps or the operator sets the pose.
class Localisation {
 public:
  static constexpr Duration kAlive = 500ms;  ///< Odometry older than this: the driver is silent.

  /// `start` and `start_height` (m): of the odometry frame in the map.
  Localisation(const Pose2& start, const Platform& platform, double start_height = 0.0)
      : bound_(platform), T_map_odom_(start), start_height_(start_height) {}

  /// Takes a sample. `stamp`: of the driver's clock, ns. False when the body cannot have driven there from
  /// the sample before: then the odometry frame is another one, odom_epoch() rises, and the robot is taken to
  /// be where it was in the map, as a guess.
  [[nodiscard]] bool update(const Pose3& odom, const Twist2& twist, std::uint64_t stamp, Time now) {
    const OdometrySample sample{odom, stamp, now};
    const bool continuous = !newest_ || bound_.reachable(*newest_, sample, heard_ ? kUnwatched : kRestart);
    if (!continuous) {
      T_map_odom_ = T_map_odom_ * newest_->T_odom_base.planar() * odom.planar().inverse();
      ++odom_epoch_;
      history_ = {};
    }
    newest_ = sample;
    twist_ = twist;
    heard_ = now;
    history_[next_] = {stamp, odom};
    next_ = (next_ + 1) % history_.size();
    return continuous;
  }
  /// The robot is at `pose` in the map. Its odometry, and what was mapped in its frame, stay as they are.
  void set_pose(const Pose2& pose) { T_map_odom_ = pose * odom().planar().inverse(); }

  KeptPlace kept() const { return {T_map_odom_, odom_epoch_, newest_}; }
  /// After a restart, before the first sample, which is compared with the one that was kept.
  void restore(const KeptPlace& kept) {
    T_map_odom_ = kept.T_map_odom;
    odom_epoch_ = kept.odom_epoch;
    newest_ = kept.newest;
  }

  bool initialised() const { return heard_.has_value(); }
  bool alive(Time now) const { return heard_ && now - *heard_ < kAlive; }
  /// Since the last odometry; since `start` when there was none.
  Duration silence(Time now, Time start) const { return now - heard_.value_or(start); }
  const Pose3& odom() const {
    static const Pose3 origin{};
    return newest_ ? newest_->T_odom_base : origin;
  }
  const Twist2& twist() const { return twist_; }
  /// Poses of different epochs are not in the same odometry frame.
  std::uint32_t odom_epoch() const { return odom_epoch_; }
  /// Map frame.
  Pose2 pose() const { return T_map_odom_ * odom().planar(); }
  double z() const { return odom().position.z() + start_height_; }
  const Pose2& T_map_odom() const { return T_map_odom_; }
  Eigen::Vector2d to_odom(const Eigen::Vector2d& map) const { return T_map_odom_.inverse() * map; }
  /// The same for a place with a height; a height that is not a number stays one.
  Eigen::Vector3d to_odom(const Eigen::Vector3d& map) const {
    const Eigen::Vector2d planar = to_odom(Eigen::Vector2d(map.head<2>()));
    return {planar.x(), planar.y(), map.z() - start_height_};
  }

  /// The body at a stamp of the driver's clock (both stamps are his), else the newest one.
  Pose3 odom_at(std::uint64_t stamp) const {
    const Entry* best = nullptr;
    for (const Entry& e : history_)
      if (e.stamp != 0 && (!best || distance(e.stamp, stamp) < distance(best->stamp, stamp))) best = &e;
    return best && distance(best->stamp, stamp) < 200'000'000 ? best->odom : odom();
  }

 private:
  struct Entry {
    std::uint64_t stamp{};
    Pose3 odom{};
  };
  static std::uint64_t distance(std::uint64_t a, std::uint64_t b) { return a > b ? a - b : b - a; }

  /// How long a body may drive on after a sample: until the agent sends zero, or its parent does. The sample
  /// that was kept over a restart is up to 1 s older than the end of the agent.
  static constexpr Duration kUnwatched = kAlive + 250ms, kRestart = kUnwatched + 1250ms;

  MotionBound bound_;
  Pose2 T_map_odom_;
  double start_height_;
  std::uint32_t odom_epoch_{};
  std::optional<OdometrySample> newest_{};
  Twist2 twist_{};
  std::optional<Time> heard_{};
  std::array<Entry, 32> history_{};  // 0.64 s at 50 Hz
  std::size_t next_{};
};

}  // namespace adit::agent
