#pragma once
#include <array>
#include <optional>

#include "core/geometry/pose.hpp"
#include "core/time/time.hpp"

namespace adit::agent {

/// Where the robot is: its start pose in the map, carried on by odometry. Nothing else is known.
class Localisation {
 public:
  static constexpr Duration kAlive = 500ms;  ///< odometry older than this: the driver is silent

  /// `start`: map frame; the odometry frame's origin lies there.
  explicit Localisation(const Pose2& start) : start_(start) {}

  /// `odom`: body in the odometry frame; `twist`: body frame; `stamp`: of the driver's clock, ns.
  void update(const Pose3& odom, const Twist2& twist, std::uint64_t stamp, Time now) {
    odom_ = odom;
    twist_ = twist;
    heard_ = now;
    history_[next_] = {stamp, odom};
    next_ = (next_ + 1) % history_.size();
  }

  bool initialised() const { return heard_.has_value(); }
  bool alive(Time now) const { return heard_ && now - *heard_ < kAlive; }
  /// Since the last odometry; since `start` when there was none.
  Duration silence(Time now, Time start) const { return now - heard_.value_or(start); }
  const Pose3& odom() const { return odom_; }
  const Twist2& twist() const { return twist_; }
  /// Map frame.
  Pose2 pose() const { return start_ * odom_.planar(); }
  double z() const { return odom_.position.z(); }
  Eigen::Vector2d to_odom(const Eigen::Vector2d& map) const { return start_.inverse() * map; }

  /// The body at a stamp of the driver's clock (both stamps are his), else the newest one.
  Pose3 odom_at(std::uint64_t stamp) const {
    const Entry* best = nullptr;
    for (const Entry& e : history_)
      if (e.stamp != 0 && (!best || distance(e.stamp, stamp) < distance(best->stamp, stamp))) best = &e;
    return best && distance(best->stamp, stamp) < 200'000'000 ? best->odom : odom_;
  }

 private:
  struct Entry {
    std::uint64_t stamp{};
    Pose3 odom{};
  };
  static std::uint64_t distance(std::uint64_t a, std::uint64_t b) { return a > b ? a - b : b - a; }

  Pose2 start_;
  Pose3 odom_{};
  Twist2 twist_{};
  std::optional<Time> heard_{};
  std::array<Entry, 32> history_{};  // 0.64 s at 50 Hz
  std::size_t next_{};
};

}  // namespace adit::agent
