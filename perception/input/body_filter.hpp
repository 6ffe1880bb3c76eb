// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <vector>

#include "core/config/platform.hpp"

namespace adit::perception {

/// The space that the robot's own body takes: its footprint and a margin, from the ground up to its highest
/// part.
class BodyFilter {
 public:
  /// `margin`: around the footprint, m.
  explicit BodyFilter(const Platform& platform, double margin = 0.02);

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
    float distance{};          ///< From base_link, the margin included, m.
  };
  std::vector<Edge> edges_{};
  float radius2_{}, top_{}, bottom_{};
};

}  // namespace adit::perception
