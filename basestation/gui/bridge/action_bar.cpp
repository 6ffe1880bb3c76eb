// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/bridge/action_bar.hpp"

#include <algorithm>
#include <string_view>

#include "basestation/gui/break.hpp"
#include "basestation/model/action.hpp"
#include "core/command/vocabulary.hpp"
#include "core/command/words.hpp"

namespace adit::gui {
namespace {

using station::Action;
using station::Robot;

const Action* find_action(const std::vector<Action>& actions, std::string_view id) {
  for (const Action& action : actions)
    if (station::id_of(action) == id) return &action;
  return nullptr;
}

/// Adds a name that is not among them yet.
void add_once(std::vector<std::string>& names, const std::string& name) {
  if (std::ranges::count(names, name) == 0) names.push_back(name);
}

std::string line_for(const Slot& slot, const std::vector<std::string>& robots) {
  std::string line = slot.before + (" " + words_of(robots));
  if (*slot.after != 0) line += " " + std::string(slot.after);
  return line;
}

/// Why an action that the robot would accept changes nothing.
std::string useless(std::string_view id, const Robot& robot) {
  if (id == "take" && robot.mine) return "you hold it already";
  if (id == "reset" && robot.stops.empty()) return "no stop is set";
  if (id == "mode_hold" && robot.mode == "hold") return "it holds already";
  return {};
}

class Builder {
 public:
  Builder(const station::World& world, const std::vector<std::string>& selection) {
    for (const std::string& name : selection)
      if (const Robot* robot = world.robot(name)) {
        robots_.push_back(robot);
        actions_.push_back(station::actions({robot}));
      }
  }

  ActionBar build() {
    for (const Slot& slot : kSlots)
      if (std::string_view(slot.id) == "convoy")
        add_convoy(slot);
      else if (std::string_view(slot.id) == "drive")
        add_drive(slot);
      else
        add(slot);
    merge();
    return std::move(bar_);
  }

 private:
  void add(const Slot& slot) {
    std::string id = slot.id;
    Slot row = slot;
    // One place for both: locked robots are unlocked once all of the selection are.
    const bool all_locked =
        !robots_.empty() && std::all_of(robots_.begin(), robots_.end(),
                                        [](const Robot* robot) { return robot->mine && robot->locked; });
    if (id == "lock" && all_locked) row.before = "unlock", row.label = "Unlock", id = "unlock";
    BarButton button{.id = slot.id, .label = row.label, .key = slot.key};
    std::vector<std::string> holders, stoppers;
    for (std::size_t i = 0; i < robots_.size(); ++i) {
      const Robot& robot = *robots_[i];
      const Action* action = find_action(actions_[i], id);
      if (!action) {
        refuse(row, robot, Reason::mode_not_installed, std::string(describe(Reason::mode_not_installed)));
        continue;
      }
      button.label = station::label_of(*action);
      const std::string nothing = action->valid ? useless(id, robot) : "";
      // The holder may clear the stops of others, but not by the way.
      const bool of_others = id == "reset" && action->reason == Reason::stop_of_another && robot.mine;
      if (of_others) {
        row.after = "--override";
        button.touch = Touch::hold;
        for (const std::string& stopper : robot.stops) add_once(stoppers, stopper);
      } else if (!action->valid || !nothing.empty()) {
        refuse(row, robot, action->reason, nothing.empty() ? action->text : nothing);
        continue;
      }
      button.robots.push_back(robot.name);
      if (id == "take" && !robot.holder.empty()) {
        add_once(holders, robot.holder);
        button.touch = Touch::hold;
      }
    }
    if (id == "goto") button.touch = Touch::place;
    if (!button.robots.empty()) button.line = line_for(row, button.robots);
    if (button.robots.size() < robots_.size() && !button.robots.empty())
      button.hint = std::to_string(button.robots.size()) + "/" + std::to_string(robots_.size());
    button.short_hint = button.hint;
    const auto hint = [&](const std::string& text, const char* brief) {
      button.hint += (button.hint.empty() ? "" : " ") + text;
      button.short_hint = brief;
    };
    if (!holders.empty())
      hint("from " + command::joined(holders, ""), holders.size() > 1 ? "from others" : "from another");
    if (!stoppers.empty())
      hint("stop of " + command::joined(stoppers, ""),
           stoppers.size() > 1 ? "stops of others" : "stop of another");
    push(std::move(button));
  }

  /// The one place that asks for a press that is held because of many robots.
  void push(BarButton button) {
    if (needs_hold(button.id, button.robots.size()))
      button.touch = button.touch == Touch::place ? Touch::place_held : Touch::hold;
    if (button.short_hint.empty() && !button.robots.empty())
      button.short_hint =
          std::to_string(button.robots.size()) + (button.robots.size() == 1 ? " robot" : " robots");
    bar_.buttons.push_back(std::move(button));
  }

  /// By hand: one robot that offers a mode for it.
  void add_drive(const Slot& slot) {
    BarButton button{.id = slot.id, .label = slot.label, .key = slot.key};
    if (robots_.size() == 1) {
      const Robot& robot = *robots_[0];
      const Action* best = nullptr;
      for (const char* mode : {"mode_smart_joystick", "mode_manual"})
        if (const Action* action = find_action(actions_[0], mode); action && (!best || !best->valid))
          best = action;
      if (best && best->valid)
        button.robots = {robot.name};
      else
        refuse(slot, robot, best ? best->reason : Reason::mode_not_installed,
               best ? best->text : std::string(describe(Reason::mode_not_installed)));
    } else if (!robots_.empty()) {
      refuse(slot, *robots_[0], Reason::none, "one robot at a time: select one");
    }
    push(std::move(button));
  }

  /// Whether all of the selection are in one convoy, and whether its leader is among them.
  bool in_one_convoy() const {
    return !robots_.empty() && !robots_[0]->convoy.empty() &&
           std::all_of(robots_.begin(), robots_.end(),
                       [&](const Robot* robot) { return robot->convoy == robots_[0]->convoy; });
  }

  /// One place for what changes a convoy: it is started, ended by its leader, or left by followers. The robot
  /// that was selected first leads.
  void add_convoy(const Slot& slot) {
    BarButton button{.id = slot.id, .label = slot.label};
    std::vector<std::string> names;
    for (const Robot* robot : robots_) {
      names.push_back(robot->name);
      if (robot->mine && !robot->lost) continue;
      const Reason reason = robot->lost             ? Reason::no_answer
                            : robot->holder.empty() ? Reason::nobody_holds
                                                    : Reason::not_holder;
      refuse(slot, *robot, reason,
             reason == Reason::not_holder ? robot->holder + " holds the robot; take it first"
                                          : std::string(describe(reason)));
      names.clear();
      break;
    }
    if (in_one_convoy() && !names.empty()) {
      const std::string& leader = robots_[0]->convoy.front();
      const bool leads = std::count(names.begin(), names.end(), leader) > 0;
      button.label = leads ? "End convoy" : "Peel off";
      button.robots = leads ? std::vector{leader} : names;
      button.line = (leads ? "convoy stop " : "peeloff ") + words_of(button.robots);
    } else if (names.size() == 1) {
      refuse(slot, *robots_[0], Reason::none,
             "select the leader, and then those that follow, in their order");
    } else if (names.size() > command::kMaxConvoy) {
      refuse(slot, *robots_[0], Reason::none,
             "a convoy has at most " + std::to_string(command::kMaxConvoy) + " robots");
    } else if (!names.empty()) {
      button.robots = names;
      button.touch = Touch::hold;
      button.hint = names.front() + " first";
      button.short_hint = std::to_string(names.size()) + " robots";
      button.line = line_for(slot, names);
    }
    push(std::move(button));
  }

  void refuse(const Slot& slot, const Robot& robot, Reason reason, const std::string& why) {
    Refusal next{.label = slot.label, .robots = robot.name, .why = why};
    cure(next, robot, reason);
    // One row for all that a robot refuses for the same reason.
    for (Refusal& known : bar_.not_now)
      if (known.robots == next.robots && known.why == why && known.cure_line == next.cure_line) {
        known.label += std::string(", ") + slot.label;
        return;
      }
    bar_.not_now.push_back(std::move(next));
  }

  /// One row for robots that refuse the same for the same reason, where no cure names one of them.
  void merge() {
    std::vector<Refusal> merged;
    for (Refusal& next : bar_.not_now) {
      const auto known = std::find_if(merged.begin(), merged.end(), [&](const Refusal& row) {
        return row.label == next.label && row.why == next.why && row.cure_line.empty() &&
               next.cure_line.empty();
      });
      if (known == merged.end())
        merged.push_back(std::move(next));
      else
        known->robots += ", " + next.robots;
    }
    bar_.not_now = std::move(merged);
  }

  static void cure(Refusal& refusal, const Robot& robot, Reason reason) {
    const auto set = [&](std::string label, std::string line, bool hold) {
      refusal.cure_label = std::move(label);
      refusal.cure_line = std::move(line);
      refusal.cure_hold = hold;
    };
    if (reason == Reason::nobody_holds) set("Take " + robot.name, "take " + robot.name, false);
    if (reason == Reason::not_holder && !robot.holder.empty() && !robot.locked)
      set("Take " + robot.name + " from " + robot.holder, "take " + robot.name, true);
    if (reason == Reason::stopped && robot.mine && (robot.stopped_by_holder && robot.stops.size() == 1))
      set("Reset " + robot.name, "reset " + robot.name, false);
    if ((reason == Reason::stopped || reason == Reason::stop_of_another) && robot.mine &&
        (!robot.stopped_by_holder || robot.stops.size() > 1))
      set("Reset all stops of " + robot.name, "reset " + robot.name + " --override", true);
  }

  std::vector<const Robot*> robots_{};
  std::vector<std::vector<Action>> actions_{};
  ActionBar bar_{};
};

}  // namespace

std::string words_of(const std::vector<std::string>& robots) {
  if constexpr (kBreakAllImplied) return "all";
  std::string words;
  for (const std::string& robot : robots) words += (words.empty() ? "" : " ") + robot;
  return words;
}

bool needs_hold(std::string_view action, std::size_t robots) {
  constexpr std::size_t kMany = 3;
  return robots > kMany && action != "stop" && action != "mode_hold";
}

ActionBar bar_of(const station::World& world, const std::vector<std::string>& selection) {
  return Builder(world, selection).build();
}

}  // namespace adit::gui
