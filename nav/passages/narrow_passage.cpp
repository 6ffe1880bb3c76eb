// SPDX-License-Identifier: Apache-2.0
#include "nav/passages/narrow_passage.hpp"

#include <cmath>

#include "nav/passages/widest_strip.hpp"

namespace adit::nav {
namespace {

constexpr double kTrackingError = 0.10;  // Tracking error and the map's cell size together, m.
constexpr double kDrift = 0.005;         // Standard deviation of the lateral odometry drift per metre.

}  // namespace

double narrow_width(const Platform& platform, double approach) {
  return platform.width + 2 * (kTrackingError + 3 * kDrift * approach);
}

std::optional<NarrowPassage> fit_passage(const NarrowPassage& guess,
                                         std::span<const ObstaclePoint> obstacles) {
  const auto strip = fit_widest_strip({0, 0, std::atan2(guess.axis.y(), guess.axis.x())}, obstacles);
  if (!strip) return std::nullopt;
  NarrowPassage passage;
  passage.middle = {guess.middle.x() + strip->line.x, guess.middle.y() + strip->line.y, guess.middle.z()};
  passage.axis = {std::cos(strip->line.yaw), std::sin(strip->line.yaw)};
  passage.clear_width = strip->room;
  return passage;
}

}  // namespace adit::nav
