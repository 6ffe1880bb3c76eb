// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "nav/routing/route_planner.hpp"
#include "sim/world/world.hpp"

namespace adit::sim {

/// Gives the global planner the complete world: the floors of each column that have headroom for the
/// platform, and as obstacles what stands beside them.
void add_world(const World& world, const Platform& platform, nav::RoutePlanner& planner);

}  // namespace adit::sim
