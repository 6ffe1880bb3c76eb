// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "basestation/model/robot.hpp"
#include "core/command/vocabulary.hpp"

namespace adit::station {

/// A command and whether a robot would accept it now.
struct Action {
  const command::CommandInfo* info{};  ///< Its arguments, danger and number of robots.
  std::string command{};               ///< As typed: "take", "mode waypoint".
  std::string mode{};                  ///< The requested mode, for `mode`.
  bool valid{};
  Reason reason{Reason::none};
  std::string text{};   ///< Why not, or a remark on its effect.
  std::string robot{};  ///< In a selection of several robots, the first that would refuse.
};

/// Whether the robot would enter the mode now. For the manual modes the station adds a centred stick.
bool can_enter(const ModeOption& option);

/// The stable identifier of the action for front ends: "take", "mode_waypoint".
std::string id_of(const Action& action);
/// The label of the action's button: "Take", "Waypoint", "Go to".
std::string label_of(const Action& action);

/// Every command for a selection of robots, in the order of the command table: valid if each of them would
/// accept it, by its authority, its stops and the modes it offers. Conditions that only the robot knows (is
/// the goal reachable?) are left to its answer.
std::vector<Action> actions(const std::vector<const Robot*>& selection);

}  // namespace adit::station
