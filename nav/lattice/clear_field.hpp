// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <span>
#include <vector>

#include "nav/lattice/solid_points.hpp"
#include "nav/terrain/obstacle_point.hpp"

namespace adit::nav {

/// How far it is from any place near the robot to the nearest obstacle: a grid of 5 cm around the origin of
/// the obstacles' frame. Fixed size; nothing is allocated after construction.
class ClearField {
 public:
  static constexpr int kSide = 192;
  static constexpr float kCell = 0.05f;              ///< m
  static constexpr float kHalf = kCell * kSide / 2;  ///< m from the middle to the border
  static constexpr float kFar = 3.0f;                ///< m: so far or farther

  ClearField();

  /// Takes the obstacles, `ahead` m farther along x: those of cost 1 as solid, others as ground that costs.
  /// The distances are exact from
  /// cell to cell (P. Felzenszwalb and D. Huttenlocher, "Distance transforms of sampled functions", 2012).
  void fill(std::span<const ObstaclePoint> obstacles, float ahead = 0.0f);
  /// From (x, y) to the nearest solid cell, m; kFar beside the grid.
  float clearance(float x, float y) const {
    const int i = cell(x), j = cell(y);
    return inside(i) && inside(j) ? distance_[index(i, j)] : kFar;
  }
  /// The solid obstacles themselves.
  const SolidPoints& points() const { return points_; }
  /// What it costs to be there, [0, 1).
  float cost(float x, float y) const {
    const int i = cell(x), j = cell(y);
    return inside(i) && inside(j) ? cost_[index(i, j)] : 0.0f;
  }

 private:
  static int cell(float v) { return static_cast<int>((v + kHalf) / kCell); }
  static bool inside(int i) { return i >= 0 && i < kSide; }
  static std::size_t index(int i, int j) { return static_cast<std::size_t>(j * kSide + i); }
  void transform(std::size_t first, std::size_t stride);

  std::vector<float> distance_, cost_;
  SolidPoints points_{};
  std::array<float, kSide> row_{}, out_{};
  std::array<int, kSide> parabola_{};
  std::array<float, kSide + 1> border_{};
};

}  // namespace adit::nav
