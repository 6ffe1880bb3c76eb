// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/config/platform.hpp"
#include "core/geometry/scan_points.hpp"
#include "perception/input/body_filter.hpp"
#include "perception/input/deskew.hpp"
#include "perception/input/frame_tree.hpp"
#include "perception/input/isolated_returns.hpp"
#include "perception/input/tilt_filter.hpp"
#include "perception/types/sweep.hpp"

namespace adit::perception {

/// Numbers of a scan's points, by what became of them.
struct ScanCounts {
  std::size_t used{};
  std::size_t not_finite{};    ///< No return.
  std::size_t out_of_range{};  ///< Nearer or farther than the lidar measures.
  std::size_t own_body{};
};

/// A problem of a scan that can be used all the same.
struct ScanWarning {
  const char* code{};  ///< Of the notification.
  Reason reason{};
  std::string text{};
};

/// One scan of all lidars, and how the body leans. Every layer gets the same.
struct Scan {
  std::uint64_t stamp{};  ///< The instant of all points, driver's clock, ns; 0: the driver sends none.
  PointCloud points{};    ///< In base_link at `stamp`, m.
  /// One for each point, not 0: without a neighbour, as dust. Empty unless asked for by mark_isolated().
  std::vector<std::uint8_t> isolated{};
  std::vector<ScanPart> parts{};  ///< Of the points, by lidar; at least one.
  bool planar{false};             ///< The first lidar has one horizontal ring.
  /// R_level_base: roll and pitch of the body by its IMU. Nothing: the attitude is the odometry's.
  std::optional<Eigen::Quaterniond> attitude{};
  ScanCounts counts{};
  bool deskewed{false};
  std::vector<ScanWarning> warnings{};
};

/// A pose with the yaw of `T_odom_base` and this roll and pitch.
Pose3 with_attitude(const Pose3& T_odom_base, const Eigen::Quaterniond& R_level_base);
/// The points of a scan in gravity's axes: x is forward, level; as base_link's where the attitude is not
/// known.
PointCloud levelled(const Scan& scan);

/// Prepares scans: extrinsics, deskewing, attitude, and what is no return.
///
/// Several lidars are merged: the sweeps of the first one set the time, and the newest sweep of each other
/// one is moved there. Pure: poses and stamps come in as values, and no clock is read.
class ScanInput {
 public:
  explicit ScanInput(const Platform& platform);

  /// One fixed transform, as tf_static has it. Errors: those of FrameTree::set.
  Result<void> add_transform(const std::string& parent, const std::string& child,
                             const Pose3& T_parent_child) {
    return tree_.set(parent, child, T_parent_child);
  }
  /// One sample of the IMU. Errors: frame_unknown; sensor_times without a stamp; those of TiltFilter::add.
  Result<void> add(const ImuSample& sample, const std::string& frame);
  /// T_base_imu for samples with this frame_id. The file's mounting counts for its own frame and for none,
  /// whatever a lidar's frame is called; another name is looked up. Error: frame_unknown.
  Result<Pose3> mounting_of_imu(const std::string& frame) const;
  /// What the body drives by its odometry, body frame, m/s, and its yaw, rad.
  void add_odometry(std::uint64_t stamp, const Eigen::Vector3d& velocity, double yaw);

  /// The last instant of a sweep, to which its points are moved, ns. Poses up to it are needed for deskewing.
  static std::uint64_t end_of(const Sweep& sweep);

  /// Whether the sweep is of one horizontal ring: a planar scanner's, or a cloud whose points all lie at the
  /// height of lidar `index`. `frame`: its frame_id.
  bool is_planar(const Sweep& sweep, std::size_t index, const std::string& frame) const;
  /// One sweep of lidar `index` of Platform::all_lidars(). Nothing when it waits for a sweep of the first
  /// lidar.
  ///
  /// @param frame  The frame_id of the message; base_link: points are there already.
  /// @param pose   T_odom_base over the time of the sweep.
  /// Errors: frame_unknown; sample_stale for a sweep that is older than the last one, sensor_times when many
  /// are; scan_empty without any return, unless the lidar may see nothing; lidar_mounting; imu_mounting.
  Result<std::optional<Scan>> add(const Sweep& sweep, std::size_t index, const std::string& frame,
                                  const PoseFunction& pose);

  /// Whether scans say which points of the first lidar are isolated; see IsolatedReturns.
  void mark_isolated(bool mark) { marks_isolated_ = mark; }

  /// The filter of the IMU; null: the platform has none.
  const TiltFilter* tilt() const { return tilt_ ? &*tilt_ : nullptr; }
  /// The samples of the IMU are in g and are scaled.
  bool imu_in_g() const { return tilt_ && tilt_->in_g(); }
  /// T_base_frame: by the platform's file, then by tf_static. Error: frame_unknown.
  Result<Pose3> find(const std::string& frame) const;

 private:
  /// A lidar, its newest sweep, and the counts by which it is judged.
  struct Source {
    LidarConfig lidar{};
    std::uint64_t newest{};           ///< Stamp of the newest sweep.
    std::uint64_t stamp{};            ///< Of `points`.
    PointCloud points{};              ///< Of the newest sweep, base_link at `stamp`.
    Eigen::Vector3d origin{0, 0, 0};  ///< Of their rays, base_link at `stamp`, m.
    bool must_return{};               ///< Its beams reach the ground, by the platform's file.
    bool returned{};                  ///< It has returned something.
    bool saw_ground{};                ///< An earlier sweep had returns below the lidar.
    int overtaken{};  ///< Rises by each sweep that comes after a newer one, falls by the others.
    int missed{};     ///< Scans in a row without a sweep of it.
  };
  /// The motion during a sweep, and the time of its first point.
  struct SweepMotion {
    Deskew deskew;
    float first{};  ///< After Sweep::stamp, s.
  };
  Result<void> filter(const ImuSample& sample, const std::string& frame);
  /// Errors: sample_stale, sensor_times.
  static Result<void> in_order(Source& source, std::uint64_t stamp);
  /// Whether the lidar can be there; `below`: returns of `scan` that are below it. Errors: scan_empty,
  /// lidar_mounting.
  Result<void> plausible(Source& source, const Sweep& sweep, const Scan& scan, std::size_t below) const;
  SweepMotion motion_of(const Sweep& sweep, const PoseFunction& pose, const Pose3& T_base_sensor,
                        Scan& scan) const;
  /// Adds the returns of a sweep and counts its other points. `moved`: the points are in base_link already.
  /// `mounted`: the lidar in base_link, m. Returns the number of returns below the lidar.
  std::size_t add_points(const Source& source, const Sweep& sweep, const SweepMotion& motion, bool moved,
                         const Eigen::Vector3f& mounted, Scan& scan);
  void note_attitude(Scan& scan);
  Result<std::optional<Eigen::Quaterniond>> attitude_at(std::uint64_t stamp) const;
  static void merge(Source& other, const PoseFunction& pose, Scan& scan);

  Platform platform_;
  BodyFilter body_;
  IsolatedReturns isolated_{};
  bool marks_isolated_{false};
  FrameTree tree_{};
  std::vector<Source> sources_{};
  std::optional<TiltFilter> tilt_{};
  std::string imu_frame_{};
  bool imu_refused_{false};  ///< A sample of the IMU was, since the last scan.
  int without_imu_{};        ///< Scans in a row.
  int scattered_{};          ///< Scans in a row.
};

}  // namespace adit::perception
