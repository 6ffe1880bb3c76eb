// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>
#include <span>

#include "nav/passages/narrow_passage.hpp"
#include "nav/route/surface_map.hpp"

namespace adit::nav {

/// Finds the first narrow passage over the first `ahead` metres of a route: where the widest straight strip
/// between what stands on both sides is no wider than `width`, m. A robot on the route keeps at least about
/// `beside` from it, m. The place that the route begins in is none, but a door at the end of a corridor is.
/// Nothing when there is none, or the map does not know.
std::optional<NarrowPassage> find_gate(const SurfaceMap& map, std::span<const Eigen::Vector3d> points,
                                       double ahead, double width, double beside);

}  // namespace adit::nav
