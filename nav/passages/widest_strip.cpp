// SPDX-License-Identifier: Apache-2.0
#include "nav/passages/widest_strip.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace adit::nav {
namespace {

constexpr int kFits = 3;                        ///< Each starts from the result of the previous one.
constexpr int kTurns = 15;                      ///< Number of headings tried to each side of the guess.
constexpr double kTurn = M_PI / 180.0;          ///< Angle between them, rad.
constexpr float kAlong = 0.5f, kAcross = 1.2f;  ///< Obstacles within these distances of the guess count, m.

std::optional<WidestStrip> fit_once(const Pose2& guess, std::span<const ObstaclePoint> obstacles) {
  struct Strip {
    float c, s, left{kAcross}, right{-kAcross};
  };
  std::array<Strip, 2 * kTurns + 1> strips;
  for (int n = -kTurns; n <= kTurns; ++n)
    strips[n + kTurns] = {static_cast<float>(std::cos(n * kTurn)), static_cast<float>(std::sin(n * kTurn))};
  const IntoPose into(guess);
  for (const ObstaclePoint& o : obstacles) {
    if (o.cost < 1.0f) continue;
    const Eigen::Vector2f at = into(o.x, o.y);
    const float x = at.x(), y = at.y();
    if (std::fabs(x) > kAlong || std::fabs(y) > kAcross) continue;
    for (Strip& strip : strips) {
      const float across = strip.c * y - strip.s * x;
      if (y > 0)
        strip.left = std::min(strip.left, across);
      else
        strip.right = std::max(strip.right, across);
    }
  }
  // Among strips of about the same width, prefers the one that is turned least.
  const auto width = [](const Strip& strip) { return strip.left - strip.right; };
  float widest = 0;
  for (const Strip& strip : strips) widest = std::max(widest, width(strip));
  const auto off = [](std::size_t i) { return std::abs(static_cast<int>(i) - kTurns); };
  std::size_t best = strips.size();
  for (std::size_t i = 0; i < strips.size(); ++i)
    if (width(strips[i]) > widest - 1e-3f && (best == strips.size() || off(i) < off(best))) best = i;
  const Strip& strip = strips[best];
  if (strip.left >= kAcross || strip.right <= -kAcross || width(strip) <= 0) return std::nullopt;
  const Pose2 turned = guess * Pose2{0, 0, (static_cast<int>(best) - kTurns) * kTurn};
  return WidestStrip{turned * Pose2{0, double{strip.left + strip.right} / 2, 0}, double{width(strip)}};
}

}  // namespace

std::optional<WidestStrip> fit_widest_strip(const Pose2& guess, std::span<const ObstaclePoint> obstacles) {
  auto best = fit_once(guess, obstacles);
  for (int fit = 1; best && fit < kFits; ++fit) {
    const auto again = fit_once(best->line, obstacles);
    if (!again || again->room <= best->room + 1e-3) break;
    best = again;
  }
  return best;
}

}  // namespace adit::nav
