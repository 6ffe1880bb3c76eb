// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <span>
#include <vector>

#include "nav/planners/hybrid_astar/solid_points.hpp"
#include "nav/terrain/obstacle_point.hpp"

namespace adit::nav {

/// Distance field: the distance from any place near the robot to the nearest obstacle, on a 5 cm grid around
/// the origin of the obstacles' frame. The size is fixed, and nothing is allocated after construction.
class DistanceField {
 public:
  static constexpr int kSide = 192;
  static constexpr float kCell = 0.05f;              ///< m
  static constexpr float kHalf = kCell * kSide / 2;  ///< Distance from the centre to the border, m.
  static constexpr float kFar = 3.0f;                ///< Upper limit of the distances, m.

  /// Updates the field. `ahead`: offset added to x, m. Obstacles of cost 1 are solid; others are ground with
  /// a cost. The distances are exact from cell to cell (P. Felzenszwalb and D. Huttenlocher, "Distance
  /// transforms of sampled functions", 2012).
  void fill(std::span<const ObstaclePoint> obstacles, float ahead = 0.0f);
  /// Distance from (x, y) to the nearest solid cell, m; kFar outside of the grid.
  float clearance(float x, float y) const {
    const int i = cell(x), j = cell(y);
    return inside(i) && inside(j) ? distance_[index(i, j)] : kFar;
  }
  /// The solid obstacles as points.
  const SolidPoints& points() const { return points_; }
  /// Cost of the ground, [0, 1).
  float cost(float x, float y) const {
    const int i = cell(x), j = cell(y);
    return inside(i) && inside(j) ? cost_[index(i, j)] : 0.0f;
  }

 private:
  static int cell(float v) { return static_cast<int>((v + kHalf) / kCell); }
  static bool inside(int i) { return i >= 0 && i < kSide; }
  static std::size_t index(int i, int j) { return static_cast<std::size_t>(j * kSide + i); }
  void transform(std::size_t first, std::size_t stride);

  static constexpr float kNone = 1e6f;  ///< No obstacle in the row, squared cells.
  std::vector<float> distance_ = std::vector<float>(kSide * kSide, kFar);
  std::vector<float> cost_ = std::vector<float>(kSide * kSide, 0.0f);
  SolidPoints points_{};
  std::array<float, kSide> row_{}, out_{};
  std::array<int, kSide> parabola_{};
  std::array<float, kSide + 1> border_{};
};

}  // namespace adit::nav
