// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <vector>

#include "core/config/platform.hpp"

namespace adit::perception {

/// The space that the robot's own body takes: its footprint, from the ground up to its highest part. No
/// margin is added, because a wall that nearly touches the body must be seen.
class BodyFilter {
 public:
  explicit BodyFilter(const Platform& platform);

  /// Whether a return at `p` (base_link, m) is of the body itself.
  bool contains(const Eigen::Vector3f& p) const {
    if (p.x() * p.x() + p.y() * p.y() > radius2_ || p.z() > top_ || p.z() < bottom_) return false;
    for (const Edge& edge : edges_)
      if (edge.normal.x() * p.x() + edge.normal.y() * p.y() > edge.distance) return false;
    return true;
  }

 private:
  struct Edge {
    Eigen::Vector2f normal{};  ///< Outwards.
    float distance{};          ///< From base_link, m.
  };
  std::vector<Edge> edges_{};
  float radius2_{}, top_{}, bottom_{};
};

}  // namespace adit::perception
