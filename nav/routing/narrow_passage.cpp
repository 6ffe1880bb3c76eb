// SPDX-License-Identifier: Apache-2.0
#include "nav/routing/narrow_passage.hpp"

#include <cmath>
#include <vector>

#include "nav/passages/widest_strip.hpp"

namespace adit::nav {
namespace {

// Minimum cosine between the sides and exact opposition across the route.
constexpr double kOppositeCosine = 0.5;
constexpr int kLongestMouth = 6;    // Samples: a longer passage is represented by its mouth.
constexpr double kNarrower = 0.15;  // A door at the end of a passage is at least this much narrower, m.
constexpr double kFitReach = 1.4;   // Radius around the centre in which obstacles are used, m.
// Sides that are not opposite are farther apart than the strip between them, m.
constexpr double kLoose = 0.15;
constexpr double kTrackingError = 0.10;  // Tracking error and the map's cell size together, m.
constexpr double kDrift = 0.005;         // Standard deviation of the lateral odometry drift per metre.

// The obstacles on both sides of a place.
struct Sides {
  Eigen::Vector2d left{0, 0}, right{0, 0};
  double width{0};  // From side to side through the place, m.
  bool both{false};
};

// Finds the sides of a place. `along`: unit vector. Both sides count when together they are at most `width`
// apart, because a route need not run in the middle.
Sides sides_of(const SurfaceMap& map, const Eigen::Vector3d& at, const Eigen::Vector2d& along, double width,
               double beside) {
  Sides sides;
  const double farthest = width - beside;
  double least_left = farthest * farthest, least_right = least_left;
  bool left = false, right = false;
  map.visit_obstacles(at, farthest, [&](const Eigen::Vector2d& place) {
    const Eigen::Vector2d away = place - at.head<2>();
    const double d2 = away.squaredNorm();
    const double across = along.x() * away.y() - along.y() * away.x();
    if (d2 >= (across > 0 ? least_left : least_right) ||
        across * across < kOppositeCosine * kOppositeCosine * d2)
      return;
    (across > 0 ? least_left : least_right) = d2;
    (across > 0 ? sides.left : sides.right) = place;
    (across > 0 ? left : right) = true;
  });
  sides.width = std::sqrt(least_left) + std::sqrt(least_right);
  sides.both = left && right && sides.width <= width;
  return sides;
}

// The obstacles around a place, relative to it.
std::vector<ObstaclePoint> obstacles_near(const SurfaceMap& map, const Eigen::Vector3d& at) {
  std::vector<ObstaclePoint> points;
  map.visit_obstacles(at, kFitReach, [&](const Eigen::Vector2d& place) {
    const Eigen::Vector2f off = (place - at.head<2>()).cast<float>();
    points.push_back({off.x(), off.y(), 1.0f});
  });
  return points;
}

// Fits the widest straight strip between obstacles, which are relative to `at`, starting there along `axis`.
// Its sides need not be opposite each other. Nothing if one side is open.
std::optional<NarrowPassage> fit_passage(const Eigen::Vector3d& at, const Eigen::Vector2d& axis,
                                         std::span<const ObstaclePoint> obstacles) {
  const auto strip = fit_widest_strip({0, 0, std::atan2(axis.y(), axis.x())}, obstacles);
  if (!strip) return std::nullopt;
  return NarrowPassage{{at.x() + strip->line.x, at.y() + strip->line.y, at.z()},
                       {std::cos(strip->line.yaw), std::sin(strip->line.yaw)},
                       strip->room};
}

}  // namespace

double narrow_width(const Platform& platform, double approach) {
  return platform.width + 2 * (kTrackingError + 3 * kDrift * approach);
}

std::optional<NarrowPassage> find_passage(const SurfaceMap& map, std::span<const Eigen::Vector3d> points,
                                          double ahead, double width, double beside) {
  Eigen::Vector2d left(0, 0), right(0, 0), along(0, 0);
  double z = 0;
  int samples = 0;
  const double loose = width + kLoose;
  double most = -1;  // Maximum width of a passage, m; negative: at the start of the route.
  // Ends a run of samples; nothing if the fitted strip is wider than `width`.
  const auto passage = [&]() -> std::optional<NarrowPassage> {
    const Eigen::Vector2d middle = (left + right) / (2.0 * samples), across = left - right;
    const Eigen::Vector3d at(middle.x(), middle.y(), z);
    const auto obstacles = obstacles_near(map, at);
    auto fitted = fit_passage(at, along, obstacles);
    // For a route that crosses a wall at an angle, the normal of the line between the sides is a better
    // guess.
    const Eigen::Vector2d normal = Eigen::Vector2d(across.y(), -across.x()).normalized();
    const auto other = fit_passage(at, normal.dot(along) < 0 ? Eigen::Vector2d(-normal) : normal, obstacles);
    if (other && (!fitted || other->clear_width > fitted->clear_width)) fitted = other;
    left = right = {0, 0};
    samples = 0;
    return fitted && fitted->clear_width <= width ? fitted : std::nullopt;
  };
  double passed = 0;
  for (std::size_t i = 0; i + 1 < points.size() && passed < ahead; ++i) {
    const Eigen::Vector3d way = points[i + 1] - points[i];
    const double length = way.head<2>().norm();
    if (length < 1e-6) continue;
    const Eigen::Vector2d direction = way.head<2>() / length;
    for (double s = 0; s < length && passed + s < ahead; s += kRouteCell) {
      const Eigen::Vector3d at = points[i] + way * (s / length);
      const Sides sides = sides_of(map, at, direction, loose, beside);
      // The place where the route begins is no passage. A clearly narrower place, or one after a wide place,
      // may be.
      if (most < 0) most = sides.width - kNarrower;
      if (!sides.both) most = loose;
      if (!sides.both || sides.width > most) {
        if (samples > 0)
          if (const auto found = passage()) return found;
        continue;
      }
      left += sides.left;
      right += sides.right;
      along = direction;
      z = at.z();
      if (++samples == kLongestMouth)
        if (const auto found = passage()) return found;
    }
    passed += length;
  }
  return samples > 0 ? passage() : std::nullopt;
}

}  // namespace adit::nav
