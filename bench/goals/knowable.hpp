// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>

#include "bench/goals/course.hpp"
#include "core/geometry/pose.hpp"
#include "sim/world/standing_map.hpp"

namespace adit::bench {

/// When a robot that came along `poses` (world, one each 0.1 s) had seen enough to know that a goal is out of
/// reach for a disc of radius `pass` (m): when all that it saw stand within 20 m and in sight keeps the disc
/// from the goal, were everything else free. Sight is that of the map's blocked columns. Index of the pose;
/// nothing when that never was so.
std::optional<std::size_t> knowable_at(const Course& course, const sim::StandingMap& map, double pass,
                                       std::span<const Pose2> poses);

}  // namespace adit::bench
