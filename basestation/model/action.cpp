// SPDX-License-Identifier: Apache-2.0
#include "basestation/model/action.hpp"

#include <algorithm>

#include "basestation/model/text.hpp"

namespace adit::station {
namespace {

using command::CommandInfo;

/// Predicts the answers of one robot.
class Judge {
 public:
  Judge(const Robot& robot, const std::vector<std::string>& modes) : robot_(robot), modes_(modes) {}

  std::vector<Action> all() {
    for (const CommandInfo& row : command::table()) {
      if (row.arguments[0].type != command::Type::robots || row.runs == command::Runs::query) continue;
      if (row.conditions.mode != "MODE") {
        add(row, std::string(row.name), judge(row, row.conditions.mode));
        continue;
      }
      for (const std::string& mode : modes_) {
        add(row, std::string(row.name) + " " + mode, judge(row, mode));
        actions_.back().mode = mode;
      }
    }
    return std::move(actions_);
  }

 private:
  static Action refuse(Reason reason, std::string text = {}) {
    if (text.empty()) text = describe(reason);
    return {.valid = false, .reason = reason, .text = std::move(text)};
  }

  void add(const CommandInfo& row, std::string typed, Action action) {
    action.info = &row;
    action.command = std::move(typed);
    // A lost robot receives nothing, but a stop is still attempted.
    if (robot_.lost && row.name != "stop") {
      action.valid = false;
      action.reason = Reason::no_answer;
      action.text = "the robot has not been heard for more than 3 s";
    }
    actions_.push_back(std::move(action));
  }

  /// Judges by the row's conditions; `take` and `reset` have further ones.
  Action judge(const CommandInfo& row, std::string_view mode_wanted) const {
    if (row.name == "take") return take();
    if (row.conditions.holder) {
      Action action = authority();
      if (!action.valid) return action;
    }
    if (row.name == "reset") return reset();
    if (!row.conditions.in.empty() && robot_.mode != row.conditions.in)
      return refuse(Reason::wrong_mode,
                    "only in " + std::string(row.conditions.in) + "; the robot is in " + robot_.mode);
    if (mode_wanted.empty()) return {.valid = true};
    // A stick that is pushed in smart_joystick does not change the mode.
    const bool stick = row.name != "mode" && mode_wanted == "manual";
    Action action = mode(stick && robot_.mode == "smart_joystick" ? robot_.mode : std::string(mode_wanted));
    // These two reasons concern the present goal, not the one that will be given.
    const bool goal = action.reason == Reason::goal_missing || action.reason == Reason::goal_unreachable;
    return goal && row.name != "mode" ? Action{.valid = true} : action;
  }

  Action authority() const {
    if (robot_.mine) return {.valid = true};
    if (robot_.holder.empty()) return refuse(Reason::nobody_holds);
    return refuse(Reason::not_holder, robot_.holder + " holds the robot; take it first");
  }

  Action mode(const std::string& name) const {
    const auto choice = std::find_if(robot_.options.begin(), robot_.options.end(),
                                     [&](const ModeOption& c) { return c.mode == name; });
    if (choice == robot_.options.end()) return refuse(Reason::mode_not_installed);
    return can_enter(*choice) ? Action{.valid = true} : refuse(choice->reason);
  }

  Action take() const {
    if (robot_.mine) return {.valid = true, .text = "you hold it already"};
    if (robot_.locked) return refuse(Reason::locked, "locked by " + robot_.holder);
    if (!robot_.holder.empty()) return {.valid = true, .text = robot_.holder + " will be notified"};
    return {.valid = true};
  }

  /// Judges `reset`, for the holder.
  Action reset() const {
    if (robot_.stops.empty()) return {.valid = true, .text = "no stop is set"};
    if (!robot_.stopped_by_holder)
      return refuse(Reason::stop_of_another, "stopped by " + robot_.stops.front() + "; use reset --override");
    return {.valid = true};
  }

  const Robot& robot_;
  const std::vector<std::string>& modes_;
  std::vector<Action> actions_{};
};

/// The modes that any robot of the selection offers, in the order offered.
std::vector<std::string> offered(const std::vector<const Robot*>& selection) {
  std::vector<std::string> modes;
  for (const Robot* robot : selection)
    for (const ModeOption& choice : robot->options)
      if (std::find(modes.begin(), modes.end(), choice.mode) == modes.end()) modes.push_back(choice.mode);
  return modes;
}

}  // namespace

bool can_enter(const ModeOption& choice) {
  return choice.available || (is_by_hand(choice.mode) && (choice.reason == Reason::joystick_stale ||
                                                          choice.reason == Reason::stick_not_centred));
}

std::string id_of(const Action& action) {
  std::string id = action.command;
  std::replace(id.begin(), id.end(), ' ', '_');
  return id;
}

std::string label_of(const Action& action) {
  if (action.mode.empty() && !action.info->label.empty()) return std::string(action.info->label);
  std::string label = code_text(action.mode.empty() ? action.command : action.mode);
  if (!label.empty() && label[0] >= 'a' && label[0] <= 'z')
    label[0] = static_cast<char>(label[0] - 'a' + 'A');
  return label;
}

std::vector<Action> actions(const std::vector<const Robot*>& selection) {
  const std::vector<std::string> modes = offered(selection);
  std::vector<Action> merged;
  for (const Robot* robot : selection) {
    std::vector<Action> own = Judge(*robot, modes).all();
    for (Action& action : own) action.robot = robot->name;
    if (merged.empty()) {
      merged = std::move(own);
      continue;
    }
    for (std::size_t i = 0; i < merged.size(); ++i)  // All robots have the same commands in the same order.
      if (merged[i].valid && (!own[i].valid || merged[i].text.empty())) merged[i] = std::move(own[i]);
  }
  return merged;
}

}  // namespace adit::station
