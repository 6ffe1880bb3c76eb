// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "core/geometry/pose.hpp"
#include "nav/geometry/footprint.hpp"
#include "nav/terrain/obstacle_point.hpp"

namespace adit::nav {

/// Index of the solid obstacle points near a robot, in cells of 20 cm. It gives collision checks that are
/// exact to the millimetre, for which the cells of a DistanceField are too coarse. Nothing is allocated after
/// construction.
class SolidPoints {
 public:
  /// Takes the obstacles of cost 1, with `ahead` metres added to x; those outside of the grid are ignored.
  void fill(std::span<const ObstaclePoint> obstacles, float ahead);
  /// Depth of the deepest point inside a body at `pose`, m; negative if no point is inside: then it is minus
  /// the distance, at least -0.2.
  float depth(const Footprint& body, const Pose2& pose) const;

 private:
  struct Point {
    float x, y;
  };
  static constexpr int kSide = 48;
  static constexpr float kCell = 0.2f;
  static constexpr float kHalf = kCell * kSide / 2;
  static constexpr std::size_t kMax = 50'000;
  static int cell(float v) { return std::clamp(static_cast<int>((v + kHalf) / kCell), 0, kSide - 1); }

  std::vector<Point> points_ = std::vector<Point>(kMax);
  std::array<std::uint32_t, kSide * kSide + 1> begin_{};
};

}  // namespace adit::nav
