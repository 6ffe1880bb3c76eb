// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/behaviour/mode_table.hpp"

#include <algorithm>
#include <array>

#include "robot_agent/behaviour/modes/external.hpp"
#include "robot_agent/behaviour/modes/manual.hpp"
#include "robot_agent/behaviour/modes/waypoint.hpp"
#include "robot_agent/behaviour/stick.hpp"

namespace adit::agent {

namespace conditions {
constinit const Condition kNotStopped{"NotStopped", Reason::stopped,
                                      [](const Facts& f) { return !f.stopped; }, Scope::ending};
constinit const Condition kDriverAlive{"DriverAlive", Reason::driver_silent,
                                       [](const Facts& f) { return f.driver_alive; }, Scope::lasting};
constinit const Condition kLocalised{"Localised", Reason::no_localisation,
                                     [](const Facts& f) { return f.localised; }, Scope::lasting};
constinit const Condition kTerrainFresh{"TerrainFresh", Reason::terrain_stale,
                                        [](const Facts& f) { return f.terrain_fresh; }, Scope::lasting};
constinit const Condition kStickFresh{"StickFresh", Reason::joystick_stale,
                                      [](const Facts& f) { return f.stick_fresh; }, Scope::entry};
constinit const Condition kStickCentred{"StickCentred", Reason::stick_not_centred,
                                        [](const Facts& f) { return f.stick_centred; }, Scope::entry};
constinit const Condition kStickKept{"StickKept", Reason::joystick_stale,
                                     [](const Facts& f) { return f.stick_kept; }, Scope::ending};
constinit const Condition kGoalKnown{"GoalKnown", Reason::goal_missing,
                                     [](const Facts& f) { return f.goal_known; }, Scope::ending};
constinit const Condition kGoalFree{"GoalFree", Reason::goal_unreachable,
                                    [](const Facts& f) { return f.goal_free; }, Scope::entry};
constinit const Condition kProgramFresh{"ProgramFresh", Reason::program_silent,
                                        [](const Facts& f) { return f.program_fresh; }, Scope::lasting};
}  // namespace conditions

namespace {

using namespace conditions;

constexpr Duration kPlannerAge = 500ms;
constexpr CommandedBy kHolder{true, false}, kHolderOrAgent{true, true};

std::vector<ModeRow> shipped_rows() {
  return {
      {.name = "hold", .commanded_by = kHolderOrAgent},
      {.name = "manual",
       .commanded_by = kHolder,
       .accepts = Accepts::stick,
       .on_handover = OnHandover::falls_to_hold,
       // StickKept comes last: StickFresh reports first.
       .conditions = {kNotStopped, kDriverAlive, kStickFresh, kStickCentred, kStickKept},
       .make = ManualMode::make,
       .source_age = Stick::kFresh},
      {.name = "smart_joystick",
       .commanded_by = kHolder,
       .accepts = Accepts::stick,
       .on_handover = OnHandover::falls_to_hold,
       .conditions = {kNotStopped, kDriverAlive, kLocalised, kTerrainFresh, kStickFresh, kStickCentred,
                      kStickKept},
       .make = SmartJoystickMode::make,
       .source_age = Stick::kFresh},
      {.name = "waypoint",
       .commanded_by = kHolderOrAgent,
       .accepts = Accepts::goal,
       .goal = GoalOnLeaving::cleared,
       .on_failure = OnFailure::pauses,
       .conditions = {kNotStopped, kDriverAlive, kLocalised, kTerrainFresh, kGoalKnown, kGoalFree},
       .make = WaypointMode::make,
       .source_age = kPlannerAge},
      // Falls to hold when its program is silent, so that a program which resumes sending does not move the
      // robot by that alone.
      {.name = "external",
       .commanded_by = kHolder,
       .accepts = Accepts::program,
       .conditions = {kNotStopped, kDriverAlive, kProgramFresh},
       .make = ExternalMode::make,
       .source_age = kPlannerAge,
       .optional = true},
  };
}

constexpr std::array<std::string_view, 3> kNotInstalled{"explore", "convoy_follow", "get_out"};

}  // namespace

ModeTable::ModeTable(std::vector<ModeRow> rows) : rows_(std::move(rows)) {
  for (const ModeRow& row : rows_)
    for (const Condition& c : row.conditions)
      if (std::none_of(conditions_.begin(), conditions_.end(),
                       [&](const Condition& known) { return known.leaf == c.leaf; }))
        conditions_.push_back(c);
}

const ModeTable& ModeTable::shipped() {
  static const ModeTable table(shipped_rows());
  return table;
}

const ModeRow* ModeTable::find(std::string_view name) const {
  const auto row = std::find_if(rows_.begin(), rows_.end(), [&](const ModeRow& r) { return r.name == name; });
  return row == rows_.end() ? nullptr : &*row;
}

const ModeRow* ModeTable::accepting(Accepts what) const {
  const auto row =
      std::find_if(rows_.begin(), rows_.end(), [&](const ModeRow& r) { return r.accepts == what; });
  return row == rows_.end() ? nullptr : &*row;
}

bool known_but_not_installed(std::string_view name) {
  return std::find(kNotInstalled.begin(), kNotInstalled.end(), name) != kNotInstalled.end();
}

Reason entry_refusal(const ModeRow& row, const Facts& facts) {
  for (const Condition& condition : row.conditions)
    if (!condition.holds(facts)) return condition.reason;
  return Reason::none;
}

}  // namespace adit::agent
