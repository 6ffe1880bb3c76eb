// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <vector>

#include "nav/lattice/clear_field.hpp"

namespace adit::nav {

/// How long the way to a target is from any place near the robot, round obstacles, for a point that keeps a
/// distance from them: what a search over poses is led by. Cells of 20 cm around the origin. Nothing is
/// allocated after construction.
class WayField {
 public:
  static constexpr int kSide = 46;
  static constexpr float kCell = 0.2f;
  static constexpr float kHalf = kCell * kSide / 2;
  static constexpr float kNoWay = 1e6f;

  WayField();

  /// Ways to `target` (m, the field's frame) for a body that needs `radius` on each side. A target beside the
  /// field is approached across the border that is nearer to it than the origin (it does not lead out of a
  /// dead end); one that stands in something, as near as can be.
  void fill(const ClearField& clear, const Eigen::Vector2d& target, float radius);
  /// m; kNoWay where none leads there.
  float at(float x, float y) const;
  /// The least that is left wherever one gets to: 0, or more where the target stands in something, m.
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
