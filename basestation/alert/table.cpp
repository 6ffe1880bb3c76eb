// SPDX-License-Identifier: Apache-2.0
#include "basestation/alert/table.hpp"

#include <algorithm>
#include <array>

namespace adit::station {
namespace {

using enum Priority;

constexpr std::array kRows{
    // Motion or control is at stake.
    AlertRow{"stop_not_acknowledged", act, Ends::seen, "stop_acknowledged"},
    AlertRow{"rival_writer", act},
    AlertRow{"tilted", act},
    AlertRow{"joystick_lost", act, Ends::goes_on, "", true},
    AlertRow{"driver_lost", act, Ends::goes_on, "", true},
    AlertRow{"lost", act, Ends::heard, "back", true},
    AlertRow{"intruder", act},
    AlertRow{"name_in_use", act},
    AlertRow{"name_taken", act},
    AlertRow{"taken", act},
    AlertRow{"stopped", act, Ends::stop_cleared, "reset"},
    AlertRow{"escalated", act, Ends::seen, "restarted"},
    AlertRow{"radio_hangs", act},
    AlertRow{"battery_last", act},

    // The robot does not know where it is, cannot use what its driver sends, or is about to fail.
    AlertRow{"odometry_jumped", soon, Ends::goes_on},
    AlertRow{"localisation_lost", soon, Ends::seen, "localisation_ok"},
    AlertRow{"place_not_searched", soon, Ends::seen, "localisation_ok"},
    AlertRow{"not_localised_here", soon, Ends::goes_on},
    AlertRow{"sensor_refused", soon, Ends::understood},
    AlertRow{"sensor_silent", soon},
    AlertRow{"camera_clock", soon, Ends::understood},
    AlertRow{"detector_refused", soon, Ends::understood},
    AlertRow{"type_differs", soon, Ends::understood},
    AlertRow{"velocities_unread", soon, Ends::understood},
    AlertRow{"two_sources", soon, Ends::understood},
    AlertRow{"component_failed", soon, Ends::healthy, "component_back", false, "escalated"},
    AlertRow{"component_hung", soon, Ends::healthy, "component_back", false, "escalated"},
    AlertRow{"battery_low", soon},

    // The robot does nothing useful.
    AlertRow{"blocked", soon, Ends::goes_on, "arrived"},
    AlertRow{"unreachable", soon, Ends::goes_on, "arrived"},
    AlertRow{"stuck", soon, Ends::seen, "arrived"},
    AlertRow{"start_in_collision", soon, Ends::goes_on, "arrived"},
    AlertRow{"unknown_budget", soon, Ends::goes_on, "arrived"},
    AlertRow{"outside_area", soon},
    AlertRow{"trail_impassable", soon, Ends::goes_on},
    AlertRow{"convoy_lost", soon},
    AlertRow{"convoy_waits", soon},
    AlertRow{"convoy_split", soon},
    AlertRow{"yield_refused", soon, Ends::goes_on, "made_way"},
    AlertRow{"yield_deadlock", soon, Ends::goes_on, "made_way"},
    AlertRow{"return_refused", soon},
    AlertRow{"explore_ended", soon},

    // It can wait.
    AlertRow{"asked", soon, Ends::not_locked, "granted"},
    AlertRow{"lock_lapsed", soon},
    AlertRow{"link_lost", soon, Ends::seen, "link_back"},
    AlertRow{"tree_refused", soon},
    AlertRow{"state_lost", soon},
    AlertRow{"state_damaged", soon},
    AlertRow{"map_damaged", soon},
    AlertRow{"keyframes_damaged", soon},
    AlertRow{"map_not_stored", soon},
    AlertRow{"findings_damaged", soon},
    AlertRow{"findings_full", soon},
    AlertRow{"store_failing", soon, Ends::seen, "store_works"},
    AlertRow{"other_release", soon},
    AlertRow{"announcement_refused", soon},
    AlertRow{"radio_refused", soon},

    // News.
    AlertRow{"idle", know},  // It waits in hold or at its goal; the robot's state shows why it ended a mode.
    AlertRow{"granted", know},
    AlertRow{"released", know},
    AlertRow{"mode_changed", know},
    AlertRow{"found", know},
    AlertRow{"finding_refused", know},
    AlertRow{"explored", know},
    AlertRow{"back", know},
    AlertRow{"link_back", know},
    AlertRow{"returning", know},
    AlertRow{"component_back", know},
    AlertRow{"restarted", know},
    AlertRow{"lidar_silent", know},
    AlertRow{"obstacle_near", know},
    AlertRow{"localisation_weak", know},
    AlertRow{"wheels_slip", know},
    AlertRow{"battery_warning", know},
    AlertRow{"goal_unseen", know},
    AlertRow{"goal_moved", know},
    AlertRow{"made_way", know},
    AlertRow{"not_deskewed", know},
    AlertRow{"clock_stepped", know},
    AlertRow{"imu_in_g", know},
    AlertRow{"stop_acknowledged", know},

    AlertRow{"arrived", log},
    AlertRow{"mode_refused", log},  // The operator's own command: its outcome says it.
    AlertRow{"reset", log},
    AlertRow{"finding_withdrawn", log},
    AlertRow{"finding_changed", log},
    AlertRow{"localisation_ok", log},
    AlertRow{"map_stored", log},
    AlertRow{"store_works", log},
};

}  // namespace

std::span<const AlertRow> alert_table() { return kRows; }

const AlertRow* alert_row(std::string_view code) {
  const auto found = std::ranges::find(kRows, code, &AlertRow::code);
  return found == kRows.end() ? nullptr : &*found;
}

}  // namespace adit::station
