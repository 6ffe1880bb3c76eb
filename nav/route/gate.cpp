#include "nav/route/gate.hpp"

#include <cmath>

namespace adit::nav {
namespace {

constexpr double kOpposite = 0.5;   // the sides are this much, as a cosine, on opposite sides of the way
constexpr int kLongestMouth = 6;    // samples: of a passage its mouth counts
constexpr double kNarrower = 0.15;  // m: than the passage that a route begins in a door at its end is

// What stands on both sides of a place.
struct Sides {
  Eigen::Vector2d left{0, 0}, right{0, 0};
  double width{0};  // from side to side by way of the place, m
  bool both{false};
};

// `along`: of length one. Both, when together they are no farther than `width`: a route need not be in the
// middle.
Sides sides_of(const SurfaceMap& map, const Eigen::Vector3d& at, const Eigen::Vector2d& along, double width,
               double beside) {
  Sides sides;
  const double farthest = width - beside;
  double least_left = farthest * farthest, least_right = least_left;
  const int reach = static_cast<int>(farthest / kRouteCell) + 1;
  const int cx = route_cell(at.x()), cy = route_cell(at.y());
  bool left = false, right = false;
  for (int iy = cy - reach; iy <= cy + reach; ++iy)
    for (int ix = cx - reach; ix <= cx + reach; ++ix) {
      const int index = map.at_cell(ix, iy, at.z());
      if (index < 0) continue;
      const GroundCell& cell = map.tile(index).cells[static_cast<std::size_t>(cell_in_tile(ix, iy))];
      if (!cell.blocked) continue;
      const Eigen::Vector2d place((ix + 0.5) * kRouteCell + cell.aside_x * double{kAsideUnit},
                                  (iy + 0.5) * kRouteCell + cell.aside_y * double{kAsideUnit});
      const Eigen::Vector2d away = place - at.head<2>();
      const double d2 = away.squaredNorm();
      const double across = along.x() * away.y() - along.y() * away.x();
      if (d2 >= (across > 0 ? least_left : least_right) || across * across < kOpposite * kOpposite * d2)
        continue;
      (across > 0 ? least_left : least_right) = d2;
      (across > 0 ? sides.left : sides.right) = place;
      (across > 0 ? left : right) = true;
    }
  sides.width = std::sqrt(least_left) + std::sqrt(least_right);
  sides.both = left && right && sides.width <= width;
  return sides;
}

}  // namespace

std::optional<Gate> find_gate(const SurfaceMap& map, std::span<const Eigen::Vector3d> points, double ahead,
                              double width, double beside) {
  Eigen::Vector2d left(0, 0), right(0, 0), along(0, 0);
  double z = 0;
  int samples = 0;
  double most = -1;  // a place is a gate up to this width; negative: the route has not begun
  const auto gate = [&]() -> std::optional<Gate> {
    const Eigen::Vector2d across = (left - right) / samples, middle = (left + right) / (2.0 * samples);
    Eigen::Vector2d axis(across.y(), -across.x());
    if (axis.norm() < kRouteCell) return std::nullopt;
    axis.normalize();
    return Gate{{middle.x(), middle.y(), z}, axis.dot(along) < 0 ? Eigen::Vector2d(-axis) : axis};
  };
  double passed = 0;
  for (std::size_t i = 0; i + 1 < points.size() && passed < ahead; ++i) {
    const Eigen::Vector3d way = points[i + 1] - points[i];
    const double length = way.head<2>().norm();
    if (length < 1e-6) continue;
    const Eigen::Vector2d direction = way.head<2>() / length;
    for (double s = 0; s < length && passed + s < ahead; s += kRouteCell) {
      const Eigen::Vector3d at = points[i] + way * (s / length);
      const Sides sides = sides_of(map, at, direction, width, beside);
      // Where it begins is none; what is clearly narrower, or comes after a wide place, may be one.
      if (most < 0) most = sides.width - kNarrower;
      if (!sides.both) most = width;
      if (!sides.both || sides.width > most) {
        if (samples > 0) return gate();
        continue;
      }
      left += sides.left;
      right += sides.right;
      along = direction;
      z = at.z();
      if (++samples == kLongestMouth) return gate();
    }
    passed += length;
  }
  return samples > 0 ? gate() : std::nullopt;
}

}  // namespace adit::nav
