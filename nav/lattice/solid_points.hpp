// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "core/geometry/pose.hpp"
#include "nav/footprint.hpp"
#include "nav/terrain/obstacle_point.hpp"

namespace adit::nav {

/// The solid points near a robot, sorted by squares of 20 cm: whether a body touches one of them, to the
/// millimetre, where the cells of a ClearField are too coarse. Nothing is allocated after construction.
class SolidPoints {
 public:
  SolidPoints();
  /// Takes the obstacles of cost 1, `ahead` m farther along x; those beside the grid are left out.
  void fill(std::span<const ObstaclePoint> obstacles, float ahead);
  /// How deep the deepest point is inside a body that stands at `pose`, m; negative when none is (no less
  /// than -0.2, and only as near as that).
  float depth(const Footprint& body, const Pose2& pose) const;

 private:
  struct Point {
    float x, y;
  };
  static constexpr int kSide = 48;
  static constexpr float kCell = 0.2f;
  static constexpr float kHalf = kCell * kSide / 2;
  static constexpr std::size_t kMost = 50'000;
  static int cell(float v) { return std::clamp(static_cast<int>((v + kHalf) / kCell), 0, kSide - 1); }

  std::vector<Point> points_{};
  std::array<std::uint32_t, kSide * kSide + 1> begin_{};
};

}  // namespace adit::nav
