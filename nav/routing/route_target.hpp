// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>

#include "nav/planners/plan.hpp"
#include "nav/routing/route_follower.hpp"

namespace adit::nav {

/// The local planner's target for a step of a route follower; none without a route. Frame: that of the route.
inline Target target_of(const RouteStep& step) {
  if (step.state != RouteStep::State::along) return {};
  Target target = Target::to(step.target.head<2>());
  target.route = step.route;
  target.last = step.last;
  target.end_speed = step.end_speed;
  if (!step.last) target.tolerance = RouteStep::kTolerance;
  if (step.passage)
    target.passage = {step.passage->middle.x(), step.passage->middle.y(),
                      std::atan2(step.passage->axis.y(), step.passage->axis.x())};
  return target;
}

/// What a recovery is to know of a step.
inline RecoveryInput recovery_input(const RouteStep& step) {
  return {.route = step.route,
          .left = step.length,
          .unreachable = step.state == RouteStep::State::unreachable,
          .start_blocked = step.state == RouteStep::State::start_blocked};
}

}  // namespace adit::nav
