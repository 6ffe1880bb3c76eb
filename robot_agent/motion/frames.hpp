#pragma once
#include <optional>

#include "robot_agent/motion/map_frame.hpp"
#include "robot_agent/motion/motion_bound.hpp"
#include "robot_agent/motion/pose_history.hpp"

namespace adit::agent {

/// Owns the robot's frames (REP-105): `map` → `odom` → `base_link`.
///
/// - `T_odom_base` is the driver's odometry. It is continuous, so local maps, plans and routes live in
/// `odom`.
/// - `T_map_odom` places the odometry frame in the map. It is level (x, y, z, yaw) and changes in steps, so
///   only what operators give or see is in `map`: goals, poses, corners of routes, findings. Whoever follows
///   a goal of the map converts it with to_odom() each time.
///
/// Two epochs tell when stored coordinates lose their meaning: odom_epoch() when the odometry began again
/// elsewhere (all of `odom` is void), map_epoch() when T_map_odom changed (what was converted is void). Both
/// are stored over a restart, which raises map_epoch(), too. They are compared for equality.
/// Stamps are of the driver's clock, ns; 0 means that the driver sends none. Runs on the command strand.
class Frames {
 public:
  static constexpr Duration kAlive = 500ms;  ///< Odometry older than this: the driver is silent.

  /// `T_map_start`: where odometry begins; `start_height`: of the ground there, map frame, m.
  Frames(const Pose2& T_map_start, const Platform& platform, double start_height = 0.0)
      : bound_(platform), T_map_start_(T_map_start), T_map_odom_(T_map_start), height_(start_height) {}

  /// Takes an odometry sample. Returns false when the body cannot have driven there from the sample before:
  /// then the odometry frame is another one, odom_epoch() rises, and the robot is taken to be where it was in
  /// the map, as a guess. A sample that was overtaken by newer ones only enters the history.
  [[nodiscard]] bool update(const Pose3& T_odom_base, const Twist2& twist, std::uint64_t stamp, Time now);

  /// Corrects the place of the odometry frame in the map, as SLAM does. Moves no robot: the odometry, and
  /// what was mapped in its frame, stay as they are.
  ///
  /// @param corrected  The new T_map_odom, with the epochs of the map_frame() that it was computed from.
  /// Errors: odometry_jumped (another odometry frame), sample_stale (T_map_odom changed since, by another
  /// correction, a `pose` of an operator or a restart), out_of_range (not finite, or tilted by more than
  /// 0.02 rad).
  Result<void> correct(const MapFrame& corrected);
  /// Places the robot at `T_map_base`, as an operator says. The height stays.
  void set_pose(const Pose2& T_map_base);

  KeptPlace kept() const { return {T_map_odom_, odom_epoch_, newest_, height_, map_epoch_}; }
  /// After a restart, before the first sample, which is compared with the one that was stored.
  void restore(const KeptPlace& kept);

  bool initialised() const { return heard_.has_value(); }
  bool alive(Time now) const { return heard_ && now - *heard_ < kAlive; }
  /// Since the last odometry; since `start` when there was none.
  Duration silence(Time now, Time start) const { return now - heard_.value_or(start); }
  std::uint32_t odom_epoch() const { return odom_epoch_; }
  std::uint32_t map_epoch() const { return map_epoch_; }
  /// From which a correction is computed.
  MapFrame map_frame() const { return {Pose3::level(T_map_odom_, height_), odom_epoch_, map_epoch_}; }

  // --- odom: for navigation ---
  const Pose3& T_odom_base() const;
  /// Interpolated. Errors: out_of_range outside of the history.
  Result<Pose3> T_odom_base_at(std::uint64_t stamp) const { return history_.at(stamp); }
  /// Of the newest sample that has a stamp; 0: none has.
  std::uint64_t newest_stamp() const { return history_.newest(); }
  /// Of the body, body frame.
  const Twist2& twist() const { return twist_; }
  /// A place of the map in the odometry frame as it lies now, m. A height that is not a number stays one.
  Eigen::Vector2d to_odom(const Eigen::Vector2d& in_map) const { return T_map_odom_.inverse() * in_map; }
  Eigen::Vector3d to_odom(const Eigen::Vector3d& in_map) const;

  // --- map: for operators ---
  /// A place of the odometry frame in the map, m.
  Eigen::Vector3d to_map(const Eigen::Vector3d& in_odom) const;
  Pose2 T_map_base() const { return T_map_odom_ * T_odom_base().planar(); }
  /// Height of the body in the map, m.
  double height() const { return T_odom_base().position.z() + height_; }
  /// Where the body was, by the place of the odometry frame that is in force now. Errors: as T_odom_base_at.
  Result<Pose3> T_map_base_at(std::uint64_t stamp) const;
  const Pose2& T_map_odom() const { return T_map_odom_; }
  /// Where the robot started; neither drift nor corrections change it.
  const Pose2& T_map_start() const { return T_map_start_; }

 private:
  bool overtaken(std::uint64_t stamp);
  void jump(const OdometrySample& sample);

  MotionBound bound_;
  Pose2 T_map_start_;
  Pose2 T_map_odom_;
  double height_;  ///< Of the odometry frame's origin in the map, m.
  std::uint32_t odom_epoch_{}, map_epoch_{};
  std::optional<OdometrySample> newest_{};
  Twist2 twist_{};
  std::optional<Time> heard_{};
  PoseHistory history_{};
  int overtaken_{};  ///< Samples in a row that were older than the newest one.
};

}  // namespace adit::agent
