// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/config/platform.hpp"
#include "core/geometry/pose.hpp"
#include "core/geometry/scan_points.hpp"
#include "nav/tracking/upright_range_image.hpp"

namespace adit::nav {

/// A person or robot that moves, or moved a moment ago. Odometry frame.
struct Mover {
  static constexpr std::size_t kMax = 24;      ///< Maximum number of points.
  bool moves{false};                           ///< False: it stopped or is gone, and its velocity is zero.
  Eigen::Vector2f position{0, 0};              ///< Centre of its visible part, m.
  Eigen::Vector2f velocity{0, 0};              ///< m/s
  float sigma_velocity{};                      ///< Standard deviation of each component of the velocity, m/s.
  std::array<Eigen::Vector2f, kMax> points{};  ///< Points of its visible side, m.
  std::uint32_t count{};

  std::span<const Eigen::Vector2f> surface() const { return {points.data(), count}; }
};

/// Detects and tracks moving objects. A return in space that a scan half a second ago saw free belongs to
/// something that moved there, after Wang and Thorpe's DATMO (ICRA 2002). Nothing else counts as motion: a
/// wall that comes into sight was hidden and not seen free, and a wall along which the robot drives has
/// always been there, whatever part of it is visible. Trackers that cluster all returns and take the drift of
/// the clusters' centres for motion report such walls as moving (tysik/obstacle_detector, issue 3;
/// praveen-palanisamy/multiple-object-tracking-lidar, issue 41). Adjacent returns of this kind form an
/// observation. A Kalman filter of constant velocity follows each object; it is a mover after three
/// observations, when it is faster than the standard deviation of its velocity.
///
/// An object that moves straight away from the robot is not detected, because it hid its place itself. All
/// sizes are fixed (about 200 kB), and nothing is allocated after construction.
class Tracker {
 public:
  static constexpr std::size_t kMax = 16;  ///< Maximum number of movers.

  explicit Tracker(const Platform& platform) : platform_(platform) {}

  /// Takes the newest scan: points in base_link, m; pose of the body in the odometry frame at that time;
  /// time, s, not decreasing.
  void look(const ScanPoints& scan, const Pose3& body, double stamp_s);
  /// Objects that move or moved a moment ago, at the time of the newest scan.
  std::span<const Mover> movers() const { return {movers_.data(), mover_count_}; }
  /// Range image of the newest scan, after spread().
  const UprightRangeImage& newest() const { return images_[newest_].seen; }
  /// Time of the newest scan, s.
  double stamp_s() const { return stamp_s_; }
  /// Forgets everything. Called internally when the odometry jumps.
  void clear();

 private:
  static constexpr std::size_t kImages = 8;
  static constexpr std::size_t kTracks = 32;
  struct Image {
    UprightRangeImage seen{};
    Eigen::Vector3f sensor{0, 0, 0};  ///< Odometry frame, m.
    double stamp_s{-1e9};
  };
  /// The nearest return of a column in space that was seen free, and the number of its bins with such a
  /// return.
  struct Column {
    Eigen::Vector2f at{0, 0};
    float range{};
    int returns{};
  };
  struct Observation {
    Eigen::Vector2f middle{0, 0};
    int first{}, columns{};  ///< Of the panorama.
    bool taken{};
  };
  struct Track {
    Mover mover{};
    double place{}, both{}, speed{};  ///< Covariance of position and velocity, equal along x and y.
    double seen_s{};
    int confirmed{};  ///< Number of consecutive observations.
    bool moved{};     ///< It has been reported as a mover.
  };

  /// The youngest image that is at least `age` old, else the oldest that is older than `youngest`, else null.
  const Image* reference(double stamp_s, double age) const;
  /// Whether the odometry moved farther than the robot can in `dt` s.
  bool jumped(const Pose2& body, double dt) const;
  /// Puts the returns into `now`, and the index of the nearest point of each bin into nearest_.
  void take_in(const ScanPoints& scan, const Pose3& body, Image& now);
  /// Finds which of the nearest returns are in space that the older images saw free.
  void compare(const ScanPoints& scan, const Pose3& body, const Image* before, const Image* lately,
               const Image& now);
  void observe();
  void add_observation(int first, int columns);
  void follow(double dt);
  void confirm(Track& track, const Observation& seen);
  void show();

  Platform platform_;
  std::vector<Image> images_ = std::vector<Image>(kImages);
  std::size_t next_{0}, newest_{0};
  RayBlock block_{};
  /// Index of the nearest point by bin; behind them one element without a meaning.
  std::array<std::uint32_t, UprightRangeImage::kBins + 1> nearest_{};
  std::array<Column, UprightRangeImage::kColumns> columns_{};
  std::array<Observation, kTracks> observations_{};
  std::size_t observation_count_{0};
  std::array<Track, kTracks> tracks_{};
  std::size_t track_count_{0};
  std::array<Mover, kMax> movers_{};
  std::size_t mover_count_{0};
  Pose2 body_{};  ///< Pose at the newest scan, odometry frame.
  double stamp_s_{-1e9};
};

}  // namespace adit::nav
