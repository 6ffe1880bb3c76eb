#pragma once
#include <string>
#include <vector>

#include "basestation/fleet/fleet.hpp"
#include "core/command/vocabulary.hpp"

namespace adit::station {

/// A command and whether a robot would accept it now.
struct Action {
  const command::CommandInfo* info{};  ///< its arguments, how dangerous it is, how many robots it takes
  std::string command{};               ///< as typed: "take", "mode waypoint"
  std::string mode{};                  ///< of `mode`: the one asked for
  bool valid{};
  Reason reason{Reason::none};
  std::string text{};   ///< why not, or a remark on what it would do
  std::string robot{};  ///< in a selection of several: the first that would refuse
};

/// Whether the robot would enter the mode now. For the manual modes the station brings a centred stick along.
bool can_enter(const ModeChoice& choice);

/// What a front end knows the action by: "take", "mode_waypoint". It never changes.
std::string id_of(const Action& action);
/// What stands on its button: "Take", "Waypoint", "Go to".
std::string label_of(const Action& action);

/// Every command for a selection of robots, in the order of the command table: valid when each of them would
/// accept it, by its authority, its stops and the modes it offers. What only a robot knows (is the goal
/// reachable?) is left to its answer.
std::vector<Action> actions(const Fleet& fleet, const std::vector<const RobotView*>& selection);

}  // namespace adit::station
