// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include "core/config/platform.hpp"

namespace adit::nav {

/// Footprint of a robot: a convex polygon around base_link, grown by margins that may differ ahead, behind
/// and to the sides. It is stored as half planes, so the depth of a point inside it takes a few
/// multiplications.
class Footprint {
 public:
  /// A half plane: nx * x + ny * y <= offset inside; (nx, ny) has length one.
  struct Edge {
    float nx{}, ny{}, offset{};
  };

  Footprint() = default;
  /// The platform's polygon, or the rectangle of its length and width.
  explicit Footprint(const Platform& platform);
  /// A rectangle centred on base_link; both arguments are half sizes, m.
  Footprint(double half_length, double half_width);

  /// Grows the footprint by `along` at the front and rear and by `across` on both sides, m, beyond its
  /// margins.
  Footprint grown(double along, double across) const { return grown(along, along, across); }
  /// Grows the footprint by `ahead` at the front, `behind` at the rear and `across` on both sides, m, beyond
  /// its margins.
  Footprint grown(double ahead, double behind, double across) const;
  /// The same body facing backwards, with the same margins: `ahead` then applies to its rear.
  Footprint turned() const;

  std::span<const Edge> edges() const { return {edges_.data(), count_}; }
  /// Depth of a point (body frame, m) inside the footprint, m; negative outside, where its magnitude is a
  /// lower bound of the distance.
  float depth(float x, float y) const {
    float least = 1e9f;
    for (std::size_t i = 0; i < count_; ++i) {
      const float inside = edges_[i].offset - edges_[i].nx * x - edges_[i].ny * y;
      least = inside < least ? inside : least;
    }
    return least;
  }
  float depth(const Eigen::Vector2f& p) const { return depth(p.x(), p.y()); }
  /// Radius of the circumscribed circle around base_link, m.
  double radius() const { return radius_; }
  /// Distance from base_link to the foremost point, m.
  double front() const { return reach(1, 0); }
  /// Whether the footprint equals itself turned by 180 degrees.
  bool symmetric() const;

 private:
  /// Extent of the body along a unit direction, m.
  double reach(double nx, double ny) const;
  void build();

  static constexpr std::size_t kMaxEdges = Platform::kMaxCorners + 4;
  std::array<Eigen::Vector2d, Platform::kMaxCorners> corners_{};  ///< Counter-clockwise, without margins.
  std::size_t corner_count_{0};
  double ahead_{0}, behind_{0}, across_{0};
  std::array<Edge, kMaxEdges> edges_{};
  std::size_t count_{0};
  double radius_{0};
};

}  // namespace adit::nav
