// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/config/platform.hpp"
#include "core/time/random.hpp"
#include "sim/world/standing_map.hpp"

namespace adit::bench {

/// Where one platform's body fits in the true map, and how far it is from place to place: its footprint at
/// 16 headings on cells of 0.1 m.
class TrueMap {
 public:
  static constexpr double kCell = 0.1;  ///< m
  static constexpr int kHeadings = 16;
  static constexpr double kStartClearance = 0.02;  ///< Beside a body that starts, m.
  static constexpr double kPassClearance = 0.08;   ///< Beside a body on its way, m.
  static constexpr float kFar = 1e9f;              ///< The distance to what cannot be reached.

  TrueMap(const sim::World& world, const Platform& platform);

  const Platform& platform() const { return platform_; }
  const sim::StandingMap& standing() const { return standing_; }
  int nx() const { return nx_; }
  int ny() const { return ny_; }
  Eigen::Vector2d middle(int i, int j) const { return origin_ + kCell * Eigen::Vector2d(i + 0.5, j + 0.5); }
  int column(double v, int axis) const { return static_cast<int>(std::floor((v - origin_[axis]) / kCell)); }
  bool inside(int i, int j) const { return i >= 0 && j >= 0 && i < nx_ && j < ny_; }
  static double heading(int k);

  /// Whether the body, `clearance` metres larger on each side, touches nothing there.
  bool fits(const Pose2& pose, double clearance) const;
  /// Whether it fits in the middle of that cell at one of the headings.
  bool standable(int i, int j) const;

  /// Length of the shortest path of the body to each cell, at whatever heading, m, kFar where there is none.
  /// Turns on the spot cost nothing. The path keeps kPassClearance, or kStartClearance within 1 m of `from`.
  std::vector<float> distances(const Pose2& from) const;
  /// The least of `distances` within `tolerance` of a place.
  float distance_to(const std::vector<float>& distances, const Eigen::Vector2d& goal, double tolerance) const;

  /// A pose drawn among those where the body fits with that clearance; nothing if none was found.
  std::optional<Pose2> draw_pose(Random& random, double clearance) const;

 private:
  std::size_t index(int i, int j) const { return static_cast<std::size_t>(j) * nx_ + i; }
  std::uint16_t fitting(int i, int j, double clearance) const;

  Platform platform_;
  sim::StandingMap standing_;
  Eigen::Vector2d origin_;
  int nx_, ny_;
  std::vector<std::uint16_t> start_{}, pass_{};  ///< Headings that fit with either clearance, one bit each.
};

}  // namespace adit::bench
