// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>

namespace adit::nav {
class LocalNavigation;
class RoutePlanner;
}  // namespace adit::nav

namespace adit::agent {

struct PlanJob;
struct RouteJob;

/// Functions that look at a robot's maps, for programs that compare them; empty in the product. Each is
/// called in the compute job of the map's component, after its scan entered the map. The jobs of one robot do
/// not overlap in a rehearsal of one thread.
struct MapWatch {
  std::function<void(const PlanJob&, const nav::LocalNavigation&)> local{};
  std::function<void(const RouteJob&, const nav::RoutePlanner&)> route{};
};

}  // namespace adit::agent
