// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Geometry>
#include <vector>

#include "sim/world/rectangle.hpp"
#include "sim/world/world.hpp"

namespace adit::sim {

/// Where a body of a given height and step can stand: the world as its wheels and its hull meet it. Made once
/// for each platform; never changes afterwards.
///
/// A column is blocked when it has no floor with headroom, or when its lowest such floor lies more than a
/// step above the lowest floor next to it. So walls, furniture and the edges of steps are blocked; slopes and
/// steps that the body climbs are not.
class StandingMap {
 public:
  /// `height` of the body above the ground, m; `step`: highest step it climbs, m.
  StandingMap(const World& world, double height, double step);

  /// Height of the ground under a body at (x, y), m: the floors around, averaged, so that it rides over the
  /// steps of a voxel map smoothly. NaN where there is none.
  double ground(double x, double y) const;
  /// Height of the ground under a wheel or foot at (x, y), m: floors that carry within `kSupport` m, the
  /// nearer the more, and no farther from `expected` (m) than `reach`. `expected` where there are none.
  double contact(double x, double y, double expected, double reach) const;
  /// Whether a footprint touches a blocked column.
  bool touches(const Rectangle& footprint) const;
  /// Distance from the footprint's border to the nearest blocked column, m, within half a column; 0 when it
  /// touches; infinite in a world where nothing is blocked. Beside an open map it is a lower bound, never
  /// less than the distance to the rectangle that holds all blocked columns.
  double clearance(const Rectangle& footprint) const;
  /// Whether the column that holds (x, y) is blocked.
  bool blocked(double x, double y) const { return blocked_at(column(x, 0), column(y, 1)); }
  /// Distance from (x, y) to the middle of the nearest blocked column, m; see clearance.
  double distance(double x, double y) const;

 private:
  /// Floors within this distance carry the body, m.
  static constexpr double kSupport = 0.25;

  int column(double v, int axis) const {
    return static_cast<int>(std::floor((v - origin_[axis]) / resolution_));
  }
  bool blocked_at(int i, int j) const;
  Eigen::Vector2d middle(int i, int j) const {
    return origin_ + resolution_ * Eigen::Vector2d(i + 0.5, j + 0.5);
  }
  std::size_t index(int i, int j) const { return static_cast<std::size_t>(j) * nx_ + i; }
  void block(const World& world, double height, double step);
  void smooth();
  void measure();

  Eigen::Vector2d origin_;
  double resolution_;
  int nx_, ny_;
  bool open_sides_;
  double outside_floor_;         ///< Ground beside an open world, m.
  std::vector<float> floor_{};   ///< In m, NaN: none.
  std::vector<float> ground_{};  ///< Averaged, m, NaN: none near.
  std::vector<std::uint8_t> blocked_{};
  Eigen::AlignedBox2d bounds_{};   ///< Bounds of the middles of all blocked columns.
  std::vector<float> distance_{};  ///< Distance between middles to the nearest blocked column, m.
};

}  // namespace adit::sim
