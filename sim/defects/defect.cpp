// SPDX-License-Identifier: Apache-2.0
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
    Defect{"both_namesakes_obey", "rule 1: of two robots of one name neither gives way",
           d::both_namesakes_obey},
    Defect{"kind_by_position", "rule 2: from `lock` on, a command is taken for the next one of the list",
           d::kind_by_position},
    Defect{"ignore_lock", "rule 2: a locked robot goes to any station that asks", d::ignore_lock},
    Defect{"silent_refusal", "rule 3: refusals are not acknowledged", d::silent_refusal},
    Defect{"stop_needs_holder", "rule 4: only the holder can stop", d::stop_needs_holder},
    Defect{"joystick_clears_stop", "rule 4: a joystick sample clears the stops", d::joystick_clears_stop},
    Defect{"drives_through_stop", "rule 4: mode table and behaviour tree do not ask whether it is stopped",
           d::drives_through_stop},
    Defect{"two_sources", "rule 5: the stick moves the robot in modes that do not take it", d::two_sources},
    Defect{"change_without_zero", "rule 5: a change of source does not pass through zero",
           d::change_without_zero},
    Defect{"no_zero_on_stale", "rule 6: the last velocity goes on when the joystick falls silent",
           d::no_zero_on_stale},
    Defect{"age_at_handling", "rule 6: a scan's age counts from its handling, 300 ms after it came",
           d::age_at_handling},
    Defect{"zero_of_other_type",
           "rule 6: the parent process sends its zero as a Twist to a driver of TwistStamped", d::none,
           d::zero_of_other_type},
    Defect{"odometry_jump_accepted", "rule 7: it drives on when its odometry jumps",
           d::odometry_jump_accepted},
    Defect{"move_on_reset", "rule 7: reset resumes the stored goal", d::move_on_reset},
    Defect{"manual_survives_handover", "rule 7: a manual mode goes on under the next holder",
           d::manual_survives_handover},
    Defect{"enter_off_centre", "rule 7: a manual mode is entered with the stick pushed", d::enter_off_centre},
    Defect{"follows_nobody", "rule 8: convoy_follow needs no place in a convoy, and drives ahead",
           d::follows_nobody},
    Defect{"yields_unasked", "rule 8: get_out needs no robot that asks, and drives ahead", d::yields_unasked},
    Defect{"yield_wakes_stopped", "rule 8: a request while it is stopped lets it make way after the reset",
           d::yield_wakes_stopped},
    Defect{"lock_forgotten", "rule 9: the lock does not survive a restart", d::lock_forgotten},
    Defect{"acknowledged_lost", "rule 9: the disk acknowledges the state, and writes it up to 5 s later",
           d::acknowledged_lost},
    Defect{"state_lost_whole", "rule 9: one damaged entry costs the whole state", d::state_lost_whole},
    Defect{"findings_deleted_at_start", "rule 9: a start deletes the findings", d::findings_deleted_at_start},
    Defect{"return_forgotten", "rule 9: a return on a nearly empty battery that was refused is not repeated",
           d::return_forgotten},
    Defect{"fence_soft", "rule 10: areas are accepted, but limit nothing", d::fence_soft},
    Defect{"sigma_not_kept",
           "rule 10: it keeps no distance from forbidden ground for the deviation that it states",
           d::sigma_not_kept},
    Defect{"area_ends_outside", "rule 10: an area binds no robot that was driven out of it by hand",
           d::area_ends_outside},
    Defect{"sigma_small", "rule 11: its pose drifts by 5 cm a second, and it states a deviation of 1 cm",
           d::sigma_small},
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
