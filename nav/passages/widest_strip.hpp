// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>

#include "core/geometry/pose.hpp"
#include "nav/terrain/obstacle_point.hpp"

namespace adit::nav {

/// The straight path through a gap: the centre line of the widest free strip.
struct WidestStrip {
  Pose2 line{};    ///< A pose on the line, about in the middle of the gap, heading through.
  double room{0};  ///< Width of the strip, m.
};

/// Fits the strip. `guess`: about the middle of the gap, between its sides, heading within 30 degrees; same
/// frame as the obstacles. Only solid obstacles at most 0.5 m before or behind the guess count. Returns
/// nothing if one side is open.
std::optional<WidestStrip> fit_widest_strip(const Pose2& guess, std::span<const ObstaclePoint> obstacles);

}  // namespace adit::nav
