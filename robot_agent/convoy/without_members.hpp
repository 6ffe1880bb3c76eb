// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "robot_agent/discovery/peer_table.hpp"
#include "robot_agent/motion/planner.hpp"

namespace adit::agent {

/// Returns the scan without the returns of the other robots of a convoy, for the route map: the robot ahead
/// is known to drive on, and must not block the route along its own path. Local planner and collision monitor
/// get the whole scan, so that no message of another robot hides an obstacle from them.
///
/// @param T_map_body  Pose of the body when the scan was taken.
/// @param members  Names of the robots in the convoy.
/// Returns `scan` itself if no member is near.
std::shared_ptr<const Scan> without_members(const std::shared_ptr<const Scan>& scan, const Pose2& T_map_body,
                                            const std::vector<std::string>& members, const PeerTable& peers,
                                            Time now);

}  // namespace adit::agent
