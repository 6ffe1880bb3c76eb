// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/config/traversability.hpp"
#include "core/geometry/pose.hpp"
#include "nav/dynamic/panorama.hpp"
#include "nav/footprint.hpp"

namespace adit::nav {

struct NearPointsParams {
  double body_margin{0.02};  ///< returns this close around the footprint are the own body, m, [0, 0.5]
  double shortest{0.35};     ///< nearer to the lidar nothing may be seen, m, [0, 1]
  double memory{10.0};       ///< what no newer scan can show is kept so long, s, [0, 60]
  double noise{0.02};        ///< of one return's range, m, standard deviation, [0, 0.2]
  double most_doubt{0.05};   ///< a place is nearer than seen by no more, m, [0, 0.2]
};

/// What stands near the robot by its newest scan, and nothing else: no map, no ground model. A return is an
/// obstacle when it is higher than ground could be at its distance, or much higher than what was seen
/// directly below it, or where such a one was seen before. What the newest scan cannot show, below its lowest
/// ray or nearer than its shortest, is taken from those before. Fixed sizes; nothing is allocated after
/// construction.
///
/// Heights are in gravity's axes, so that a body that leans over a stone sees the same obstacles as a level
/// one. The ground may lie as the body does (on a ramp) or level (a body that leans by itself): something is
/// an obstacle only if it is too high for the higher of both, and looked at from the lower one on.
class NearPoints {
 public:
  static constexpr std::size_t kMost = 4096;  ///< places; the nearest ones when there are more
  /// Where something stands, m, odometry frame: the mean of the returns of one 5 cm cell.
  struct Place {
    float x{}, y{};
    float z{};      ///< Of the highest one, m.
    float doubt{};  ///< it may be so much nearer than it was seen: three standard deviations of the mean
    double seen{};
  };

  /// `reach`: how far around base_link it looks, m, (0, 4].
  NearPoints(const Platform& platform, double reach, const NearPointsParams& params = {});

  /// One scan: points in base_link, m, the body in the odometry frame then, and the time, s; and what it saw
  /// by direction.
  void take(std::span<const Eigen::Vector3f> points, const Pose3& body, double stamp_s, const Panorama& seen);
  /// Forgets what was seen.
  void clear() { places_.clear(); }
  std::span<const Place> places() const { return {places_.data(), places_.size()}; }

 private:
  static constexpr int kSide = 160;  ///< cells of 5 cm
  static constexpr int kCoarse = 80;
  static constexpr float kCell = 0.05f;
  struct Cell {
    float x, y, z;  ///< Sums of x and y, the highest z: level axes at base_link, m.
    std::uint16_t count;
  };
  /// The rays of the newest scan, as rise per metre.
  struct Fan {
    float lowest{1e9f}, highest{-1e9f};
  };

  static std::size_t coarse(float x, float y);
  static std::size_t fine(float x, float y);
  /// How the body leans: level axes are base_link's, turned upright, with its yaw.
  struct Lean {
    Eigen::Matrix3f R_level_base{Eigen::Matrix3f::Identity()};
    Eigen::Vector2f rise{0, 0};  ///< Of the plane that the body stands on, per metre along the level x and y.
    float slope{};               ///< The ground may rise so much per metre from the footprint on.
  };
  Lean lean_of(const Pose3& body) const;
  Fan sort_in(std::span<const Eigen::Vector3f> points, const Lean& lean);
  /// Whether one step before `p` the ground was seen: flat, at most `highest`, and no more than `rise` lower.
  bool tread_leads_to(const Eigen::Vector3f& p, float range, float highest, float rise) const;
  bool seen_again(const Eigen::Vector2f& local) const;
  void remember(const Pose3& body, const Lean& lean, const Fan& fan, double stamp_s, const Panorama& seen);
  bool hidden(const Eigen::Vector3d& local, const Fan& fan) const;
  bool seen_past(const Eigen::Vector3d& local, const Pose3& body, const Panorama& seen) const;

  Platform platform_;
  NearPointsParams params_;
  Traversability limits_;
  Footprint body_;
  float reach_;
  std::vector<float> lowest_;   ///< return in each 10 cm cell, m
  std::vector<float> upper_;    ///< and the highest that is not passed under
  std::vector<float> highest_;  ///< in each 5 cm cell, of what is too high to be stepped on
  std::vector<Cell> cells_;
  std::vector<std::uint32_t> used_{};
  std::vector<Place> places_{}, kept_{};
};

}  // namespace adit::nav
