// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include "core/config/platform.hpp"

namespace adit::nav {

/// A robot seen from above: a convex polygon around base_link, grown by margins that may differ ahead, behind
/// and across the robot. As half planes, so that "how deep inside is this point" is a handful of
/// multiplications.
class Footprint {
 public:
  /// Inside is where nx * x + ny * y <= offset, for every edge; (nx, ny) has length one.
  struct Edge {
    float nx{}, ny{}, offset{};
  };

  Footprint() = default;
  /// The platform's polygon, or the rectangle of its length and width.
  explicit Footprint(const Platform& platform);
  /// A rectangle centred on base_link, half its size, m.
  Footprint(double half_length, double half_width);

  /// Grown by `along` to the front and back and by `across` to both sides, m (on top of earlier margins).
  Footprint grown(double along, double across) const { return grown(along, along, across); }
  /// Grown by `ahead` to the front, `behind` to the back and `across` to both sides, m (on top of earlier
  /// margins).
  Footprint grown(double ahead, double behind, double across) const;
  /// The same body facing the other way, with the same margins: `ahead` is then kept free before its rear.
  Footprint turned() const;

  std::span<const Edge> edges() const { return {edges_.data(), count_}; }
  /// How deep a point of the body's frame is inside, m; negative outside (never more than its distance).
  float depth(float x, float y) const {
    float least = 1e9f;
    for (std::size_t i = 0; i < count_; ++i) {
      const float inside = edges_[i].offset - edges_[i].nx * x - edges_[i].ny * y;
      least = inside < least ? inside : least;
    }
    return least;
  }
  /// Of the circle around base_link that the body stays in, m.
  double radius() const { return radius_; }
  /// From base_link to the foremost point, m.
  double front() const { return reach(1, 0); }
  /// The body looks the same from behind (turned by half a turn).
  bool symmetric() const;

 private:
  /// How far the body reaches along a direction of length one, m.
  double reach(double nx, double ny) const;
  void build();

  static constexpr std::size_t kMaxEdges = Platform::kMaxCorners + 4;
  std::array<Eigen::Vector2d, Platform::kMaxCorners> corners_{};  ///< counter-clockwise, without the margin
  std::size_t corner_count_{0};
  double ahead_{0}, behind_{0}, across_{0};
  std::array<Edge, kMaxEdges> edges_{};
  std::size_t count_{0};
  double radius_{0};
};

}  // namespace adit::nav
