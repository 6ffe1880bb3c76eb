// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "robot_agent/motion/map_frame.hpp"
#include "robot_agent/motion/motion_bound.hpp"
#include "robot_agent/motion/pose_history.hpp"

namespace adit::agent {

/// Owns the robot's frames (REP-105): `map` → `odom` → `base_link`.
///
/// - `T_odom_base` is the driver's odometry. It is continuous, so local maps, plans and routes are in `odom`.
/// - `T_map_odom` places the odometry frame in the map. It is level (x, y, z, yaw) and changes in steps, so
///   only data that operators enter or see is in `map`: goals, poses, corners of routes, findings. A
///   component that follows a goal in the map converts it with to_odom() each time.
///
/// Two epochs mark stored coordinates as invalid: odom_epoch() changes when the odometry started again
/// elsewhere (all coordinates in `odom` are invalid), map_epoch() when T_map_odom changed (converted
/// coordinates are invalid). Both are stored over a restart, which also raises map_epoch(). They are compared
/// for equality. Stamps are of the driver's clock, ns; 0 means that the driver sends none. Runs on the
/// command strand.
class Frames {
 public:
  static constexpr Duration kAlive = 500ms;  ///< Odometry older than this: the driver is silent.

  /// `T_map_start`: pose where odometry begins; `start_height`: height of the ground there, map frame, m.
  Frames(const Pose2& T_map_start, const Platform& platform, double start_height = 0.0)
      : bound_(platform), T_map_start_(T_map_start), T_map_odom_(T_map_start), height_(start_height) {}

  /// Processes an odometry sample. Returns false if the body cannot have driven there from the previous
  /// sample: then the odometry frame is a new one, odom_epoch() rises, and the robot is assumed to be at its
  /// previous pose in the map. A sample that arrives after a newer one only enters the history.
  [[nodiscard]] bool update(const Pose3& T_odom_base, const Twist2& twist, std::uint64_t stamp, Time now);

  /// Corrects the pose of the odometry frame in the map, as SLAM does. Moves no robot: the odometry, and maps
  /// in its frame, stay unchanged.
  ///
  /// @param corrected  The new T_map_odom, with the epochs of the map_frame() that it was computed from.
  /// Errors: odometry_jumped (another odometry frame), sample_stale (T_map_odom changed since, by another
  /// correction, a `pose` of an operator or a restart), out_of_range (not finite, or tilted by more than
  /// 0.02 rad).
  Result<void> correct(const MapFrame& corrected);
  /// Sets the robot's pose in the map to `T_map_base`, on an operator's request. The height stays unchanged.
  void set_pose(const Pose2& T_map_base);

  /// Makes all coordinates in `odom` invalid: the robot may have been carried elsewhere, unseen by its
  /// odometry. Its pose in the map stays until it is set.
  void begin_frame() {
    ++odom_epoch_;
    ++map_epoch_;
  }

  /// The state to store for restore() after a restart.
  StoredFrames stored() const { return {T_map_odom_, odom_epoch_, newest_, height_, map_epoch_, {}}; }
  /// Restores the stored state after a restart, before the first sample, which is then compared with the
  /// stored one.
  void restore(const StoredFrames& stored);

  bool initialised() const { return received_at_.has_value(); }
  bool alive(Time now) const { return received_at_ && now - *received_at_ < kAlive; }
  /// Time since the last odometry, or since `start` if there was none.
  Duration silence(Time now, Time start) const { return now - received_at_.value_or(start); }
  std::uint32_t odom_epoch() const { return odom_epoch_; }
  std::uint32_t map_epoch() const { return map_epoch_; }
  /// The frame from which a correction is computed.
  MapFrame map_frame() const { return {Pose3::level(T_map_odom_, height_), odom_epoch_, map_epoch_}; }

  // --- odom: for navigation ---
  const Pose3& T_odom_base() const;
  /// The interpolated pose at a stamp. Errors: out_of_range outside of the history.
  Result<Pose3> T_odom_base_at(std::uint64_t stamp) const { return history_.at(stamp); }
  /// Stamp of the newest sample that has one; 0: none has.
  std::uint64_t newest_stamp() const { return history_.newest(); }
  /// Velocity of the body, body frame.
  const Twist2& twist() const { return twist_; }
  /// Converts a point from the map frame to the odometry frame, by the present T_map_odom, m. A height of NaN
  /// stays NaN.
  Eigen::Vector2d to_odom(const Eigen::Vector2d& in_map) const { return T_map_odom_.inverse() * in_map; }
  Eigen::Vector3d to_odom(const Eigen::Vector3d& in_map) const;

  // --- map: for operators ---
  /// Converts a point from the odometry frame to the map frame, m.
  Eigen::Vector3d to_map(const Eigen::Vector3d& in_odom) const;
  Pose2 T_map_base() const { return T_map_odom_ * T_odom_base().planar(); }
  /// Height of the body in the map, m.
  double height() const { return T_odom_base().position.z() + height_; }
  const Pose2& T_map_odom() const { return T_map_odom_; }
  /// The start pose of the robot; neither drift nor corrections change it.
  const Pose2& T_map_start() const { return T_map_start_; }

 private:
  /// Whether a sample with this stamp is slightly older than the newest one.
  bool is_late(std::uint64_t stamp) const;
  /// Whether the body can have driven between the newest sample and this one.
  bool is_reachable(const OdometrySample& sample, bool late) const;
  void begin_odometry_frame(const OdometrySample& sample);

  MotionBound bound_;
  Pose2 T_map_start_;
  Pose2 T_map_odom_;
  double height_;  ///< Height of the odometry frame's origin in the map, m.
  std::uint32_t odom_epoch_{}, map_epoch_{};
  std::optional<OdometrySample> newest_{};
  Twist2 twist_{};
  std::optional<Time> received_at_{};  ///< Time of the last sample since the start of the agent.
  PoseHistory history_{};
  int consecutive_late_{};  ///< Samples in succession that were slightly older than the newest one.
};

}  // namespace adit::agent
