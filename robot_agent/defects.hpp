#pragma once
#include <array>
#include <optional>
#include <string_view>
#include <utility>

namespace adit::agent {

/// Rules of docs/architecture.md that an agent can be told to break, so that tests see the rule checker fire.
/// They exist in the library built with ADIT_DEFECTS alone (adit::agent_defects); in the product `has` is a
/// constant false and the compiler drops every branch.
enum class Defect {
  none,
  accept_without_epoch,      ///< rule 1: an old epoch counts
  repeat_done_twice,         ///< rule 1: a repeated command has its effect again, and a new answer
  obey_stranger,             ///< rule 1: commands count from stations that do not hold the robot
  ignore_lock,               ///< rule 2: a locked robot goes to whoever asks
  silent_refusal,            ///< rule 3: refusals are not acknowledged
  stop_needs_holder,         ///< rule 4: only the holder can stop
  joystick_clears_stop,      ///< rule 4: a joystick sample releases the stop
  two_sources,               ///< rule 5: sources that the tree did not enable pass, too
  change_without_zero,       ///< rule 5: a change of source does not pass through zero
  no_zero_on_stale,          ///< rule 6: the last velocity goes on when its source falls silent
  move_on_reset,             ///< rule 7: reset resumes the kept goal
  manual_survives_handover,  ///< rule 7: a manual mode goes on under the next holder
  enter_off_centre,          ///< rule 7: a manual mode is entered with the stick pushed
  accept_stale_joystick,     ///< rule 1: a sample counts however old its echo is
  epoch_kept_at_restart,     ///< rule 1: the epoch of before the restart stays in force
  lock_forgotten,            ///< rule 7: the lock does not survive a restart
  acknowledged_lost,         ///< rule 9: acknowledged before it is saved, and saved much later
  blind_planner,             ///< no rule: plans straight at the goal, through everything
  blind_and_unwatched,       ///< the same, and no collision monitor between it and the wheels
};

inline constexpr std::array<std::pair<std::string_view, Defect>, 20> kDefectNames{{
    {"none", Defect::none},
    {"accept_without_epoch", Defect::accept_without_epoch},
    {"repeat_done_twice", Defect::repeat_done_twice},
    {"obey_stranger", Defect::obey_stranger},
    {"ignore_lock", Defect::ignore_lock},
    {"silent_refusal", Defect::silent_refusal},
    {"stop_needs_holder", Defect::stop_needs_holder},
    {"joystick_clears_stop", Defect::joystick_clears_stop},
    {"two_sources", Defect::two_sources},
    {"change_without_zero", Defect::change_without_zero},
    {"no_zero_on_stale", Defect::no_zero_on_stale},
    {"move_on_reset", Defect::move_on_reset},
    {"manual_survives_handover", Defect::manual_survives_handover},
    {"enter_off_centre", Defect::enter_off_centre},
    {"accept_stale_joystick", Defect::accept_stale_joystick},
    {"epoch_kept_at_restart", Defect::epoch_kept_at_restart},
    {"lock_forgotten", Defect::lock_forgotten},
    {"acknowledged_lost", Defect::acknowledged_lost},
    {"blind_planner", Defect::blind_planner},
    {"blind_and_unwatched", Defect::blind_and_unwatched},
}};

constexpr std::optional<Defect> defect_from_name(std::string_view name) {
  for (const auto& [text, defect] : kDefectNames)
    if (text == name) return defect;
  return std::nullopt;
}

/// The defect an agent was given. The layout is the same in both builds.
struct Defects {
  Defect active{Defect::none};

#ifdef ADIT_DEFECTS
  constexpr bool has(Defect defect) const { return active == defect; }
#else
  static constexpr bool has(Defect) { return false; }
#endif
};

}  // namespace adit::agent
