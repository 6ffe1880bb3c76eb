#include "basestation/fleet/actions.hpp"

#include <algorithm>

namespace adit::station {
namespace {

/// One robot's answers to be.
class Judge {
 public:
  Judge(const Fleet& fleet, const RobotView& robot, const std::vector<std::string>& modes)
      : robot_(robot), mine_(fleet.held_by_me(robot)), modes_(modes) {}

  std::vector<Action> all() {
    take();
    for (const char* command : {"release", "lock", "unlock", "grant"}) add(command, authority());
    for (const std::string& name : modes_) {
      Action action = authority();
      if (action.valid) action = mode(name);
      add("mode " + name, action);
    }
    const bool assisted = robot_.mode == "smart_joystick";
    add("drive", steering(assisted));
    go_to();
    add("plan", Action{.valid = true});
    add("teleop", steering(assisted));
    add("stop", Action{.valid = true});
    reset();
    for (const char* command : {"restart", "policy"}) add(command, authority());
    return std::move(actions_);
  }

 private:
  static Action refuse(Reason reason, std::string text = {}) {
    if (text.empty()) text = describe(reason);
    return {.valid = false, .reason = reason, .text = std::move(text)};
  }

  void add(std::string command, Action action) {
    action.command = std::move(command);
    // A lost robot hears nothing; a stop is worth trying all the same.
    if (robot_.lost && action.command != "stop") {
      action.valid = false;
      action.reason = Reason::no_answer;
      action.text = "the robot has not been heard for more than 3 s";
    }
    actions_.push_back(std::move(action));
  }

  Action authority() const {
    if (mine_) return {.valid = true};
    if (robot_.holder.empty()) return refuse(Reason::nobody_holds);
    return refuse(Reason::not_holder, robot_.holder + " holds the robot; take it first");
  }

  Action mode(const std::string& name) const {
    const auto choice = std::find_if(robot_.choices.begin(), robot_.choices.end(),
                                     [&](const ModeChoice& c) { return c.mode == name; });
    if (choice == robot_.choices.end()) return refuse(Reason::mode_not_installed);
    if (choice->available) return {.valid = true};
    // The station brings a centred stick along when it asks for these modes.
    const bool stick = name == "manual" || name == "smart_joystick";
    if (stick && (choice->reason == Reason::joystick_stale || choice->reason == Reason::stick_not_centred))
      return {.valid = true};
    return refuse(choice->reason);
  }

  void take() {
    if (mine_) return add("take", {.valid = true, .text = "you hold it already"});
    if (robot_.locked) return add("take", refuse(Reason::locked, "locked by " + robot_.holder));
    if (!robot_.holder.empty()) return add("take", {.valid = true, .text = robot_.holder + " will be told"});
    add("take", Action{.valid = true});
  }

  Action steering(bool assisted) const {
    Action action = authority();
    return action.valid ? mode(assisted ? "smart_joystick" : "manual") : action;
  }

  void go_to() {
    Action action = authority();
    if (action.valid) action = mode("waypoint");
    // These two speak of the goal there is now, not of the one to be given.
    if (action.reason == Reason::goal_missing || action.reason == Reason::goal_unreachable)
      action = {.valid = true};
    add("goto", action);
  }

  void reset() {
    Action action = authority();
    const auto& stops = robot_.stops;
    const bool own = std::any_of(stops.begin(), stops.end(), [&](const StopLatch& stop) {
      return stop.station == robot_.holder && stop.station_id == robot_.holder_id;
    });
    if (action.valid && stops.empty()) action.text = "no stop is set";
    if (action.valid && !stops.empty() && !own)
      action =
          refuse(Reason::stop_of_another, "stopped by " + stops.front().station + "; use reset --override");
    add("reset", action);
  }

  const RobotView& robot_;
  bool mine_;
  const std::vector<std::string>& modes_;
  std::vector<Action> actions_{};
};

/// What any robot of the selection offers, in the order offered.
std::vector<std::string> offered(const std::vector<const RobotView*>& selection) {
  std::vector<std::string> modes;
  for (const RobotView* robot : selection)
    for (const ModeChoice& choice : robot->choices)
      if (std::find(modes.begin(), modes.end(), choice.mode) == modes.end()) modes.push_back(choice.mode);
  return modes;
}

}  // namespace

std::vector<Action> actions(const Fleet& fleet, const std::vector<const RobotView*>& selection) {
  const std::vector<std::string> modes = offered(selection);
  std::vector<Action> merged;
  for (const RobotView* robot : selection) {
    std::vector<Action> own = Judge(fleet, *robot, modes).all();
    for (Action& action : own) action.robot = robot->name;
    if (merged.empty()) {
      merged = std::move(own);
      continue;
    }
    for (std::size_t i = 0; i < merged.size(); ++i)  // same commands, same order
      if (merged[i].valid && (!own[i].valid || merged[i].text.empty())) merged[i] = std::move(own[i]);
  }
  return merged;
}

}  // namespace adit::station
