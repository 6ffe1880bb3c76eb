// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/config/platform.hpp"
#include "core/geometry/pose.hpp"
#include "nav/dynamic/panorama.hpp"

namespace adit::nav {

struct TrackerParams {
  double reach{8.0};         ///< looks this far around the lidar, m, [1, 30]
  double age{0.45};          ///< places are compared with what was seen this long before, s, [0.1, 0.7]
  double youngest{0.2};      ///< and half as long, for who turns about; not less than this, s, [0.05, age]
  double beyond{0.15};       ///< a ray that went so much past a place shows that it was free, m, [0.05, 1]
  double lowest{0.15};       ///< what moves is looked for above this and the step, over the ground, m, [0, 1]
  double body_margin{0.05};  ///< returns this close around the footprint are the own body, m, [0, 0.5]
  double largest{1.2};       ///< wider things are taken apart, m, [0.3, 5]
  double slowest{0.3};       ///< who is slower stands, m/s, [0.1, 2]
  double noise{0.08};        ///< of the middle of what is seen of something, m, standard deviation, (0, 1]
  double agility{2.0};       ///< acceleration of what moves, m/s2, standard deviation, (0, 10]
  double lost{0.35};         ///< what nothing confirmed for longer stands, or is gone, s, [0.1, 2]
  double memory{4.0};        ///< what moved and stands may move again, for so long, s, [0, 60]
};

/// Something that moves, or did so a moment ago: a person, another robot. Odometry frame.
struct Mover {
  static constexpr std::size_t kMost = 24;      ///< points
  bool moves{false};                            ///< false: it stands, or is gone; its velocity is zero
  Eigen::Vector2f position{0, 0};               ///< middle of what is seen of it, m
  Eigen::Vector2f velocity{0, 0};               ///< m/s
  float doubt{};                                ///< standard deviation of each part of the velocity, m/s
  std::array<Eigen::Vector2f, kMost> points{};  ///< of its side that is seen, m
  std::uint32_t count{};

  std::span<const Eigen::Vector2f> surface() const { return {points.data(), count}; }
};

/// Finds what moves in the newest scan, and how fast. Where something is now and half a second ago rays went
/// through, something has come: returns in seen free space, after Wang and Thorpe's DATMO (ICRA 2002).
/// Nothing else counts: a wall that comes into sight was hidden and not seen free, one that is driven along
/// has always been there, whatever piece of it is seen; trackers that cluster all returns and take the
/// wandering of their middles for motion report such walls as moving (tysik/obstacle_detector, issue 3;
/// praveen-palanisamy/multiple-object-tracking-lidar, issue 41). Those returns, side by side, are an
/// observation; a Kalman filter of constant velocity follows each, and what was confirmed three times and is
/// faster than its doubt moves.
///
/// What moves straight away from the robot is not found: its place was hidden by itself. Fixed sizes; nothing
/// is allocated after construction; about 200 kB.
class Tracker {
 public:
  static constexpr std::size_t kMost = 16;  ///< movers

  explicit Tracker(const Platform& platform, const TrackerParams& params = {});

  /// The newest scan: points in base_link, m; the body in the odometry frame when it was taken; the time
  /// that it came, s, not decreasing.
  void look(std::span<const Eigen::Vector3f> points, const Pose3& body, double stamp_s);
  /// What moves or did so a moment ago, as it was at the newest scan.
  std::span<const Mover> movers() const { return {movers_.data(), mover_count_}; }
  /// What the newest scan saw, by direction, spread.
  const Panorama& newest() const { return images_[newest_].seen; }
  /// Of the newest scan, s.
  double stamp_s() const { return stamp_s_; }
  /// Forgets everything; happens by itself when the odometry jumps.
  void clear();

 private:
  static constexpr std::size_t kImages = 8;
  static constexpr std::size_t kTracks = 32;
  struct Image {
    Panorama seen{};
    Eigen::Vector3f sensor{0, 0, 0};  ///< odometry frame
    double stamp_s{-1e9};
  };
  /// The nearest return of a column that is where nothing was, and in how many of its bins there is one.
  struct Column {
    Eigen::Vector2f at{0, 0};
    float range{};
    int returns{};
  };
  struct Observation {
    Eigen::Vector2f middle{0, 0};
    int first{}, columns{};  ///< of the panorama
    bool taken{};
  };
  struct Track {
    Mover mover{};
    double place{}, both{}, speed{};  ///< covariance of position and velocity, the same along x and y
    double seen_s{};
    int confirmed{};  ///< in a row
    bool moved{};     ///< it was told as a mover
  };

  /// The youngest image that is so old; when none is, the oldest that is not too young; or null.
  const Image* reference(double stamp_s, double age) const;
  /// The odometry, that is: no robot moves so far in `dt` s.
  bool jumped(const Pose2& body, double dt) const;
  /// Puts the returns into `now`, and the nearest of each bin into nearest_.
  void take_in(std::span<const Eigen::Vector3f> points, const Pose3& body, Image& now);
  /// Looks which of the nearest returns are where something was seen through.
  void compare(std::span<const Eigen::Vector3f> points, const Pose3& body, const Image* before,
               const Image* lately, const Image& now);
  void observe();
  void add_observation(int first, int columns);
  void follow(double dt);
  void confirm(Track& track, const Observation& seen);
  void show();

  Platform platform_;
  TrackerParams params_;
  std::vector<Image> images_;
  std::size_t next_{0}, newest_{0};
  RayBlock block_{};
  std::array<std::uint32_t, Panorama::kBins> nearest_{};  ///< the point that each filled bin has its range of
  std::array<Column, Panorama::kColumns> columns_{};
  std::array<Observation, kTracks> observations_{};
  std::size_t observation_count_{0};
  std::array<Track, kTracks> tracks_{};
  std::size_t track_count_{0};
  std::array<Mover, kMost> movers_{};
  std::size_t mover_count_{0};
  Pose2 body_{};  ///< at the newest scan, odometry frame
  double stamp_s_{-1e9};
};

}  // namespace adit::nav
