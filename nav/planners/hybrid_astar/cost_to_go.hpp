// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <vector>

#include "nav/planners/hybrid_astar/distance_field.hpp"

namespace adit::nav {

/// Cost-to-go map: the length of the path to a target from any place near the robot, around obstacles, for a
/// point that keeps a clearance. It is the heuristic of a search over poses. Cells of 20 cm around the
/// origin. Nothing is allocated after construction.
class CostToGo {
 public:
  static constexpr int kSide = 46;
  static constexpr float kCell = 0.2f;
  static constexpr float kHalf = kCell * kSide / 2;
  static constexpr float kUnreachable = 1e6f;

  CostToGo();

  /// Computes the paths to `target` (m, the field's frame) for a body that needs `radius` on each side. For a
  /// target outside of the field, the paths lead across the part of the border that is nearer to it than the
  /// origin (this does not lead out of a dead end); for a target inside an obstacle, as near to it as
  /// possible.
  void fill(const DistanceField& field, const Eigen::Vector2d& target, float radius);
  /// Cost to go from (x, y), m; kUnreachable if there is no path.
  float at(float x, float y) const;
  /// Minimum over the field: 0, or more if the target is inside an obstacle, m.
  float least() const { return least_; }

 private:
  struct Open {
    float cost;
    int cell;
    bool operator<(const Open& other) const { return cost > other.cost; }
  };
  static float middle(int i) { return (static_cast<float>(i) + 0.5f) * kCell - kHalf; }
  void offer(int cell, float cost);

  float least_{0};
  std::vector<float> cost_;
  std::vector<std::uint8_t> free_;
  std::vector<Open> open_{};
};

}  // namespace adit::nav
