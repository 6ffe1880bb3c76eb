#include "robot_agent/behaviour/mode_table.hpp"

#include <algorithm>
#include <array>

namespace adit::agent {
namespace {

constexpr Condition kNotStopped{"NotStopped", Reason::stopped, [](const Facts& f) { return !f.stopped; },
                                Scope::ending};
constexpr Condition kDriverAlive{"DriverAlive", Reason::driver_silent,
                                 [](const Facts& f) { return f.driver_alive; }, Scope::lasting};
constexpr Condition kLocalised{"Localised", Reason::no_localisation,
                               [](const Facts& f) { return f.localised; }, Scope::lasting};
constexpr Condition kTerrainFresh{"TerrainFresh", Reason::terrain_stale,
                                  [](const Facts& f) { return f.terrain_fresh; }, Scope::lasting};
constexpr Condition kStickFresh{"StickFresh", Reason::joystick_stale,
                                [](const Facts& f) { return f.stick_fresh; }, Scope::entry};
constexpr Condition kStickCentred{"StickCentred", Reason::stick_not_centred,
                                  [](const Facts& f) { return f.stick_centred; }, Scope::entry};
constexpr Condition kStickKept{"StickKept", Reason::joystick_stale,
                               [](const Facts& f) { return f.stick_kept; }, Scope::ending};
constexpr Condition kGoalKnown{"GoalKnown", Reason::goal_missing, [](const Facts& f) { return f.goal_known; },
                               Scope::ending};
constexpr Condition kGoalFree{"GoalFree", Reason::goal_unreachable,
                              [](const Facts& f) { return f.goal_free; }, Scope::entry};
constexpr Condition kProgramFresh{"ProgramFresh", Reason::program_silent,
                                  [](const Facts& f) { return f.program_fresh; }, Scope::lasting};

constexpr std::array kAll{kNotStopped,   kDriverAlive, kLocalised, kTerrainFresh, kStickFresh,
                          kStickCentred, kStickKept,   kGoalKnown, kGoalFree,     kProgramFresh};

// StickKept comes last: on entry the clock of the mode has not begun, StickFresh has spoken already.
constexpr std::array kManual{kNotStopped, kDriverAlive, kStickFresh, kStickCentred, kStickKept};
constexpr std::array kSmart{kNotStopped, kDriverAlive,  kLocalised, kTerrainFresh,
                            kStickFresh, kStickCentred, kStickKept};
constexpr std::array kWaypoint{kNotStopped, kDriverAlive, kLocalised, kTerrainFresh, kGoalKnown, kGoalFree};

constexpr std::array kExternal{kNotStopped, kDriverAlive, kProgramFresh};

constexpr CommandedBy kHolder{true, false}, kHolderOrAgent{true, true};

constexpr std::array kTable{
    ModeRow{"hold",
            kHolderOrAgent,
            Accepts::nothing,
            GoalOnLeaving::none,
            OnFailure::falls_to_hold,
            OnHandover::continues,
            {}},
    ModeRow{"manual", kHolder, Accepts::stick, GoalOnLeaving::none, OnFailure::falls_to_hold,
            OnHandover::falls_to_hold, kManual},
    ModeRow{"smart_joystick", kHolder, Accepts::stick, GoalOnLeaving::none, OnFailure::falls_to_hold,
            OnHandover::falls_to_hold, kSmart},
    ModeRow{"waypoint", kHolderOrAgent, Accepts::goal, GoalOnLeaving::cleared, OnFailure::pauses,
            OnHandover::continues, kWaypoint},
    // Falls to hold when its program is silent: one that comes back must not move the robot by that alone.
    ModeRow{"external", kHolder, Accepts::program, GoalOnLeaving::none, OnFailure::falls_to_hold,
            OnHandover::continues, kExternal, true},
};

constexpr std::array<std::string_view, 3> kNotInstalled{"explore", "convoy_follow", "get_out"};

}  // namespace

std::span<const ModeRow> mode_table() { return kTable; }

const ModeRow* find_mode(std::string_view name) {
  const auto row =
      std::find_if(kTable.begin(), kTable.end(), [&](const ModeRow& r) { return r.name == name; });
  return row == kTable.end() ? nullptr : &*row;
}

bool known_but_not_installed(std::string_view name) {
  return std::find(kNotInstalled.begin(), kNotInstalled.end(), name) != kNotInstalled.end();
}

Reason entry_refusal(const ModeRow& row, const Facts& facts) {
  for (const Condition& condition : row.conditions)
    if (!condition.holds(facts)) return condition.reason;
  return Reason::none;
}

std::span<const Condition> all_conditions() { return kAll; }

}  // namespace adit::agent
