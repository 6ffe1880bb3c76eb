// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "core/geometry/pose.hpp"
#include "nav/routing/route_planner.hpp"
#include "robot_agent/motion/planner.hpp"

namespace adit::agent {

/// Another robot of the team for the map of the global planner, odometry frame, m.
struct TeamRobot {
  std::string name{};
  Pose2 pose{};
  double z{};
  double length{}, width{};
  double cost{};  ///< Added to a route across it.
};

/// Returns the scan without the returns of the robots, `scan` itself if it has none. The route map
/// must not contain robots, which drive on or make way. Local planner and collision monitor get the complete
/// scan, so that no message of another robot hides an obstacle from them.
std::shared_ptr<const Scan> without_team(const std::shared_ptr<const Scan>& scan,
                                         const std::vector<TeamRobot>& team);

/// Sets the robots of the team in the planner. `half_width`: of the own body, m.
void set_team(nav::RoutePlanner& planner, const std::vector<TeamRobot>& team, double half_width);

}  // namespace adit::agent
