// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/motion/team_robot.hpp"

#include <gmock/gmock.h>

#include <limits>

namespace adit::agent {
namespace {

TEST(TeamRobots, NoLengthOfARobotKeepsTheRouterBusy) {
  nav::RoutePlanner planner(Platform{}, {});
  for (const double length :
       {600.0, 1e18, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()})
    set_team(planner, {{"r2", Pose2{1, 0, 0}, 0.0, length, length, 1.0}}, 0.3);
}

}  // namespace
}  // namespace adit::agent
