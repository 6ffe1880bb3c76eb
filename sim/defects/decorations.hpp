// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "sim/defects/defect.hpp"

/// One function for each defect; defect.cpp has the table.
namespace adit::sim::decorations {

// Of commands and who may give them.
Decoration accept_without_epoch(const Subject& subject);
Decoration repeat_done_twice(const Subject& subject);
Decoration obey_stranger(const Subject& subject);
Decoration ignore_lock(const Subject& subject);
Decoration silent_refusal(const Subject& subject);
Decoration stop_needs_holder(const Subject& subject);
Decoration joystick_clears_stop(const Subject& subject);
Decoration move_on_reset(const Subject& subject);
Decoration yield_wakes_stopped(const Subject& subject);
Decoration enter_off_centre(const Subject& subject);
Decoration both_namesakes_obey(const Subject& subject);
Decoration kind_by_position(const Subject& subject);
Decoration accept_stale_joystick(const Subject& subject);
Decoration fence_soft(const Subject& subject);
Decoration area_ends_outside(const Subject& subject);

// Of what moves the robot.
Decoration two_sources(const Subject& subject);
Decoration change_without_zero(const Subject& subject);
Decoration no_zero_on_stale(const Subject& subject);
Decoration manual_survives_handover(const Subject& subject);

// Of where it says it is.
Decoration sigma_small(const Subject& subject);
Decoration sigma_not_kept(const Subject& subject);

// Defects of its sensor input.
Decoration age_at_handling(const Subject& subject);
Decoration odometry_jump_accepted(const Subject& subject);
Decoration return_forgotten(const Subject& subject);

// Of what survives a restart.
Decoration epoch_kept_at_restart(const Subject& subject);
Decoration lock_forgotten(const Subject& subject);
Decoration acknowledged_lost(const Subject& subject);
Decoration state_lost_whole(const Subject& subject);
Decoration findings_deleted_at_start(const Subject& subject);

// Of a part that a double replaces.
Decoration blind_planner(const Subject& subject);
Decoration blind_and_unwatched(const Subject& subject);
Decoration drives_through_stop(const Subject& subject);
Decoration follows_nobody(const Subject& subject);
Decoration yields_unasked(const Subject& subject);

// Of its parent process.
Decoration none(const Subject& subject);
std::unique_ptr<wire::Participant> zero_of_other_type(std::unique_ptr<wire::Participant> parents);

}  // namespace adit::sim::decorations
