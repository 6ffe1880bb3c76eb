// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/behaviour/mode_table.hpp"

#include <algorithm>

#include "robot_agent/behaviour/modes/convoy_follow.hpp"
#include "robot_agent/behaviour/modes/explore.hpp"
#include "robot_agent/behaviour/modes/external.hpp"
#include "robot_agent/behaviour/modes/get_out.hpp"
#include "robot_agent/behaviour/modes/manual.hpp"
#include "robot_agent/behaviour/modes/waypoint.hpp"
#include "robot_agent/behaviour/stick.hpp"

namespace adit::agent {

namespace conditions {
constinit const Condition kNotStopped{"NotStopped", Reason::stopped,
                                      [](const Facts& f) { return !f.stopped; }, Scope::terminal};
constinit const Condition kDriverAlive{"DriverAlive", Reason::driver_silent,
                                       [](const Facts& f) { return f.driver_alive; }, Scope::continuous};
constinit const Condition kLocalised{"Localised", Reason::no_localisation,
                                     [](const Facts& f) { return f.localised; }, Scope::continuous};
constinit const Condition kTerrainFresh{"TerrainFresh", Reason::terrain_stale,
                                        [](const Facts& f) { return f.terrain_fresh; }, Scope::continuous};
constinit const Condition kMapFresh{"MapFresh", Reason::map_stale, [](const Facts& f) { return f.map_fresh; },
                                    Scope::continuous};
constinit const Condition kStickFresh{"StickFresh", Reason::joystick_stale,
                                      [](const Facts& f) { return f.stick_fresh; }, Scope::on_entry};
constinit const Condition kStickCentred{"StickCentred", Reason::stick_not_centred,
                                        [](const Facts& f) { return f.stick_centred; }, Scope::on_entry};
constinit const Condition kStickPresent{"StickKept", Reason::joystick_stale,
                                        [](const Facts& f) { return f.stick_present; }, Scope::terminal};
constinit const Condition kGoalKnown{"GoalKnown", Reason::goal_missing,
                                     [](const Facts& f) { return f.goal_known; }, Scope::terminal};
constinit const Condition kGoalFree{"GoalFree", Reason::goal_unreachable,
                                    [](const Facts& f) { return f.goal_free; }, Scope::on_entry};
constinit const Condition kProgramFresh{"ProgramFresh", Reason::program_silent,
                                        [](const Facts& f) { return f.program_fresh; }, Scope::continuous};
}  // namespace conditions

namespace {

using namespace conditions;

/// Maximum age of a velocity that the local planner or an external program computed (rule 6).
constexpr Duration kMaxVelocityAge = 500ms;
constexpr CommandedBy kByHolder{.holder = true, .agent = false};
constexpr CommandedBy kByHolderOrAgent{.holder = true, .agent = true};

std::vector<ModeRow> standard_modes() {
  return {
      {.name = "hold", .commanded_by = kByHolderOrAgent},
      {.name = "manual",
       .commanded_by = kByHolder,
       .accepts = Accepts::stick,
       .on_handover = OnHandover::falls_to_hold,
       // When the mode is requested without a stick, the first condition that fails is reported: StickFresh.
       // StickKept holds longer, so that the mode survives a short loss of the stick, with zero velocity.
       .conditions = {kNotStopped, kDriverAlive, kStickFresh, kStickCentred, kStickPresent},
       .make = ManualMode::make,
       .output_lifetime = Stick::kFresh},
      {.name = "smart_joystick",
       .commanded_by = kByHolder,
       .accepts = Accepts::stick,
       .on_handover = OnHandover::falls_to_hold,
       .conditions = {kNotStopped, kDriverAlive, kLocalised, kTerrainFresh, kStickFresh, kStickCentred,
                      kStickPresent},
       .make = SmartJoystickMode::make,
       .output_lifetime = Stick::kFresh},
      {.name = "waypoint",
       .commanded_by = kByHolderOrAgent,
       .accepts = Accepts::goal,
       .goal = GoalOnLeaving::cleared,
       .on_failure = OnFailure::pauses,
       .conditions = {kNotStopped, kDriverAlive, kLocalised, kTerrainFresh, kGoalKnown, kGoalFree},
       .make = WaypointMode::make,
       .output_lifetime = kMaxVelocityAge},
      {.name = "explore",
       .commanded_by = kByHolder,
       .on_failure = OnFailure::pauses,
       .conditions = {kNotStopped, kDriverAlive, kLocalised, kTerrainFresh, kMapFresh},
       .make = ExploreMode::make,
       .output_lifetime = kMaxVelocityAge,
       .optional = true},
      // Changes to hold when its program falls silent. When the program sends again, the robot does not move
      // until the operator requests the mode again (rule 7).
      {.name = "external",
       .commanded_by = kByHolder,
       .accepts = Accepts::program,
       .conditions = {kNotStopped, kDriverAlive, kProgramFresh},
       .make = ExternalMode::make,
       .output_lifetime = kMaxVelocityAge,
       .optional = true},
      ConvoyFollowMode::row(),
      GetOutMode::row(),
  };
}

/// The first condition of the row that fails, among those whose scope counts; null: all hold.
const Condition* first_failure(const ModeRow& row, const Facts& facts, auto counts) {
  for (const Condition& condition : row.conditions)
    if (counts(condition.scope) && !condition.holds(facts)) return &condition;
  return nullptr;
}

}  // namespace

ModeTable::ModeTable(std::vector<ModeRow> rows) : rows_(std::move(rows)) {
  for (const ModeRow& row : rows_)
    for (const Condition& condition : row.conditions) {
      // Rows share conditions: two conditions with the same leaf in the behaviour tree are the same.
      const bool is_known = std::any_of(conditions_.begin(), conditions_.end(),
                                        [&](const Condition& known) { return known.leaf == condition.leaf; });
      if (!is_known) conditions_.push_back(condition);
    }
}

const ModeTable& ModeTable::shipped() {
  static const ModeTable table(standard_modes());
  return table;
}

const ModeRow* ModeTable::find(std::string_view name) const {
  const auto row = std::find_if(rows_.begin(), rows_.end(), [&](const ModeRow& r) { return r.name == name; });
  return row == rows_.end() ? nullptr : &*row;
}

const ModeRow* ModeTable::find_by_input(Accepts input) const {
  const auto row =
      std::find_if(rows_.begin(), rows_.end(), [&](const ModeRow& r) { return r.accepts == input; });
  return row == rows_.end() ? nullptr : &*row;
}

Reason entry_refusal(const ModeRow& row, const Facts& facts) {
  const Condition* failed = first_failure(row, facts, [](Scope) { return true; });
  return failed ? failed->failure(facts) : Reason::none;
}

const Condition* ModeRow::ended_by(const Facts& facts) const {
  return first_failure(*this, facts, [this](Scope scope) {
    return scope == Scope::terminal || (scope == Scope::continuous && on_failure == OnFailure::falls_to_hold);
  });
}

const Condition* ModeRow::paused_by(const Facts& facts) const {
  return first_failure(*this, facts, [](Scope scope) { return scope == Scope::continuous; });
}

}  // namespace adit::agent
