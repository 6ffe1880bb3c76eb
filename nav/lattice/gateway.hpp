// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>

#include "core/geometry/pose.hpp"
#include "nav/terrain/obstacle_point.hpp"

namespace adit::nav {

/// The straight way through a gap: the line in the middle of the widest strip that is free there.
struct Gateway {
  Pose2 line{};    ///< a pose on it, about in the gap's middle, heading through
  double room{0};  ///< width of the strip, m
};

/// `guess`: about the gap's middle, between its sides and within 30 degrees, in the frame of the obstacles.
/// Of these the solid ones count that are no more than 0.5 m before or behind it. Nothing when one side is
/// open.
std::optional<Gateway> fit_gateway(const Pose2& guess, std::span<const ObstaclePoint> obstacles);

}  // namespace adit::nav
