// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>
#include <span>

#include "nav/passages/narrow_passage.hpp"
#include "nav/routing/surface_map.hpp"

namespace adit::nav {

/// Finds the first narrow passage on the first `ahead` metres of a route: a place where the widest straight
/// strip between the obstacles on both sides is at most `width`, m. `beside`: minimum distance between the
/// route and the obstacles, m. The narrow place in which the route begins does not count, but a door at the
/// end of a corridor does. Returns nothing if there is no passage or the map is unknown there.
std::optional<NarrowPassage> find_passage(const SurfaceMap& map, std::span<const Eigen::Vector3d> points,
                                          double ahead, double width, double beside);

}  // namespace adit::nav
