#pragma once
#include <string>
#include <vector>

#include "basestation/fleet/actions.hpp"
#include "basestation/fleet/fleet.hpp"
#include "basestation/send/answer.hpp"

/// The fleet model for people: lines that end in \n.
namespace adit::station {

/// A row for each robot, then the stations; `*` marks what this station holds.
std::string list_text(const Fleet& fleet, Time now);
/// All that is known of one robot.
std::string status_text(const Fleet& fleet, const RobotView& robot, Time now);
/// Bytes a second by agent and topic; `bandwidth` (bit/s, 0: not known) sets the total against the link.
std::string net_text(const Fleet& fleet, Time now, const std::string& link, double bandwidth);
/// "up", "FAILED", ...
const char* word(ComponentPhase phase);
/// A row for each component of the robots.
std::string health_text(const std::vector<const RobotView*>& robots);
/// A row for each command: whether it is valid now, and why not.
std::string actions_text(const std::vector<Action>& actions);
/// "12.3 m, 4.0 m of it not seen yet: 3.0 0.0, 12.0 0.5": its corners after the start.
std::string route_text(const Route& route);
/// "r1: taken" or "r1: refused: ... [locked]".
/// `own_name`: the operator who reads it, who need not be named as the holder.
std::string answer_text(const Answer& answer, const std::string& done, const std::string& own_name = {});

/// What stands in a MODE column: the mode, and why it does not move where that matters.
std::string mode_text(const RobotView& robot);
/// "12.0 3.5 90d": m, m, degrees; "-" before the first RobotState.
std::string pose_text(const RobotView& robot);
/// "active 12.0 0.5", or "-".
std::string goal_text(const RobotView& robot);
/// "none", or who stopped it.
std::string stops_text(const RobotView& robot);

}  // namespace adit::station
