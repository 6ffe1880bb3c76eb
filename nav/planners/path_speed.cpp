// SPDX-License-Identifier: Apache-2.0
#include "nav/planners/path_speed.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace adit::nav {
namespace {

constexpr std::size_t kStride = 4;  // Every fourth pose of the path is checked.
constexpr std::size_t kSectors = 120;
constexpr float kHiddenBehind = 0.4f;  // A place so far behind an obstacle counts as hidden, m.

std::size_t sector(double y, double x) {
  const double turn = std::atan2(y, x) / (2 * M_PI);
  return static_cast<std::size_t>((turn < 0 ? turn + 1 : turn) * kSectors) % kSectors;
}

}  // namespace

double path_speed(const Plan& plan, const Pose2& pose, const Footprint& body, const Platform& platform,
                  std::span<const ObstaclePoint> obstacles, const PathSpeedParams& params) {
  double top = platform.max_speed;
  const auto path = plan.path();
  if (path.size() < 2) return top;
  std::array<float, kSectors> nearest{};
  nearest.fill(1e9f);
  for (const ObstaclePoint& o : obstacles)
    if (o.cost >= 1.0f) {
      float& range = nearest[sector(o.y, o.x)];
      range = std::min(range, std::hypot(o.x, o.y));
    }
  const double spacing = plan.length / static_cast<double>(path.size() - 1);
  const double braking = 2 * params.braking_share * platform.max_acceleration;
  const auto enough =
      static_cast<float>((platform.max_speed - params.caution) / std::max(1e-3, params.caution_gain));
  const auto reach = static_cast<float>(body.radius()) + enough;
  const Pose2 back = pose.inverse();
  for (std::size_t i = 0; i < path.size(); i += kStride) {
    const Pose2 at = back * path[i];
    const double before = braking * spacing * static_cast<double>(i);
    if (top * top <= before) break;  // The robot can brake for anything from here on.
    const IntoPose into(at);
    float clear = enough;
    for (const ObstaclePoint& o : obstacles) {
      const float dx = o.x - into.x, dy = o.y - into.y;
      if (o.cost < 1.0f || dx * dx + dy * dy > reach * reach) continue;
      clear = std::min(clear, -body.depth(into.turn(dx, dy)));
    }
    double own = params.caution + params.caution_gain * std::max(0.0f, clear);
    if (nearest[sector(at.y, at.x)] + kHiddenBehind < std::hypot(into.x, into.y))
      own = std::min(own, params.blind);
    if (own * own + before < top * top) top = std::sqrt(own * own + before);
  }
  return top;
}

}  // namespace adit::nav
