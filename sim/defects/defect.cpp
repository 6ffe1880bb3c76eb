#include "sim/defects/defect.hpp"

#include <algorithm>
#include <array>

#include "sim/defects/decorations.hpp"

namespace adit::sim {
namespace {

namespace d = decorations;

constexpr std::array kDefects{
    Defect{"accept_without_epoch", "rule 1: the holder's commands count under an old epoch",
           d::accept_without_epoch},
    Defect{"repeat_done_twice", "rule 1: a repeated command has its effect again, and another answer",
           d::repeat_done_twice},
    Defect{"obey_stranger", "rule 1: commands of stations that do not hold the robot count",
           d::obey_stranger},
    Defect{"accept_stale_joystick", "rule 1: a joystick sample counts however old its echo is",
           d::accept_stale_joystick},
    Defect{"epoch_kept_at_restart", "rule 1: the epoch has the same start after a restart",
           d::epoch_kept_at_restart},
    Defect{"ignore_lock", "rule 2: a locked robot goes to any station that asks", d::ignore_lock},
    Defect{"silent_refusal", "rule 3: refusals are not acknowledged", d::silent_refusal},
    Defect{"stop_needs_holder", "rule 4: only the holder can stop", d::stop_needs_holder},
    Defect{"joystick_clears_stop", "rule 4: a joystick sample clears the stops", d::joystick_clears_stop},
    Defect{"two_sources", "rule 5: the stick moves the robot in modes that do not take it", d::two_sources},
    Defect{"change_without_zero", "rule 5: a change of source does not pass through zero",
           d::change_without_zero},
    Defect{"no_zero_on_stale", "rule 6: the last velocity goes on when the joystick falls silent",
           d::no_zero_on_stale},
    Defect{"move_on_reset", "rule 7: reset resumes the stored goal", d::move_on_reset},
    Defect{"manual_survives_handover", "rule 7: a manual mode goes on under the next holder",
           d::manual_survives_handover},
    Defect{"enter_off_centre", "rule 7: a manual mode is entered with the stick pushed", d::enter_off_centre},
    Defect{"lock_forgotten", "rule 9: the lock does not survive a restart", d::lock_forgotten},
    Defect{"acknowledged_lost", "rule 9: the disk acknowledges the state, and writes it up to 5 s later",
           d::acknowledged_lost},
    Defect{"blind_planner", "plans straight at the goal, through everything", d::blind_planner},
    Defect{"blind_and_unwatched", "the same, and the collision monitor sees nothing either",
           d::blind_and_unwatched},
};

}  // namespace

std::span<const Defect> defects() { return kDefects; }

const Defect* find_defect(std::string_view name) {
  const auto found = std::find_if(kDefects.begin(), kDefects.end(),
                                  [&](const Defect& defect) { return defect.name == name; });
  return found == kDefects.end() ? nullptr : &*found;
}

}  // namespace adit::sim
