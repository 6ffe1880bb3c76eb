// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "basestation/fleet/fleet.hpp"
#include "basestation/fleet/station_params.hpp"
#include "basestation/model/action.hpp"
#include "basestation/model/text.hpp"
#include "basestation/send/answer.hpp"

/// The fleet model as readable text; lines end in a newline.
namespace adit::station {

/// A row for each robot, then the stations; `*` marks robots that this station holds.
std::string list_text(const Fleet& fleet, Time now);
/// The complete state of one robot.
std::string status_text(const Fleet& fleet, const RobotView& robot, Time now);
/// Bytes/s by agent and topic, and the links. `params`: of this station, for the share of its link.
std::string net_text(const NetworkReport& report, const StationParams& params);
/// A row for each component of the robots.
std::string health_text(const HealthReport& report);
/// A row for each command: whether it is valid now, and why not.
std::string actions_text(const std::vector<Action>& actions);
/// A route and its corners after the start: "12.3 m, 4.0 m of it not seen yet: 3.0 0.0, 12.0 0.5".
std::string route_text(const contract::PlannedRoute& route);
/// An answer: "r1: taken" or "r1: refused: ... [locked]". `own_name`: the reading operator, who is not named
/// as the holder.
std::string answer_text(const Answer& answer, const std::string& done, const std::string& own_name = {});

/// The entry of a MODE column: the mode, and, where relevant, why the robot does not move.
std::string mode_text(const RobotView& robot);
/// The pose: "12.0 3.5 90d" (m, m, degrees); "-" before the first RobotState.
std::string pose_text(const RobotView& robot);
/// The goal: "active 12.0 0.5" (m), or "-".
std::string goal_text(const RobotView& robot);
/// The stops: "none", or the stopping operators.
std::string stops_text(const RobotView& robot);

}  // namespace adit::station
