// SPDX-License-Identifier: Apache-2.0
#include "core/result/reason.hpp"

#include <array>

namespace adit {
namespace {

struct Row {
  Reason reason;
  std::string_view name;
  std::string_view text;
};

constexpr std::array kRows{
    Row{Reason::none, "none", "accepted"},
    Row{Reason::not_holder, "not_holder", "another station holds the robot; take it first"},
    Row{Reason::locked, "locked", "the robot is locked by its holder; ask for a grant or a release"},
    Row{Reason::stale_epoch, "stale_epoch", "the robot changed hands since; take it again"},
    Row{Reason::stale_sequence, "stale_sequence", "a newer command was already handled"},
    Row{Reason::unknown_station, "unknown_station", "the sender has not announced itself as a basestation"},
    Row{Reason::name_in_use, "name_in_use",
        "another station with this name is on the air; choose another --name"},
    Row{Reason::identity_mismatch, "identity_mismatch", "the sender is not the station it claims to be"},
    Row{Reason::nobody_holds, "nobody_holds", "nobody holds the robot; take it first"},
    Row{Reason::unknown_operator, "unknown_operator", "no operator of that name has been heard"},
    Row{Reason::stop_of_another, "stop_of_another", "another station set this stop; use reset --override"},
    Row{Reason::would_go_on, "would_go_on",
        "robots would go on without a holder; stop them, or leave them so with: down --leave"},
    Row{Reason::wrong_robot, "wrong_robot", "the command is addressed to another robot"},
    Row{Reason::stopped, "stopped", "a software stop is set; reset it first"},
    Row{Reason::joystick_stale, "joystick_stale", "no fresh joystick sample"},
    Row{Reason::stick_not_centred, "stick_not_centred", "centre the stick first"},
    Row{Reason::driver_silent, "driver_silent", "the robot's driver is silent"},
    Row{Reason::no_localisation, "no_localisation", "localisation is not initialised"},
    Row{Reason::terrain_stale, "terrain_stale", "no fresh lidar data"},
    Row{Reason::goal_missing, "goal_missing", "there is no goal; give one with goto"},
    Row{Reason::goal_unreachable, "goal_unreachable", "the goal cannot be reached"},
    Row{Reason::mode_unknown, "mode_unknown", "no mode of that name"},
    Row{Reason::mode_not_installed, "mode_not_installed", "this robot has no module for that mode"},
    Row{Reason::sample_stale, "sample_stale", "the sample echoes too old a stamp"},
    Row{Reason::wrong_mode, "wrong_mode", "the current mode does not take this input"},
    Row{Reason::blocked, "blocked", "every path is blocked"},
    Row{Reason::program_silent, "program_silent", "the external program sends no velocities"},
    Row{Reason::obstacle_close, "obstacle_close", "an obstacle is too close to go on"},
    Row{Reason::just_restarted, "just_restarted", "the agent was started a moment ago, and listens first"},
    Row{Reason::goal_occupied, "goal_occupied", "something stands where the robot is to stand"},
    Row{Reason::goal_no_floor, "goal_no_floor", "the ground is missing at the goal"},
    Row{Reason::goal_too_steep, "goal_too_steep", "the ground at the goal is too steep or a step"},
    Row{Reason::goal_too_narrow, "goal_too_narrow", "the robot does not fit at the goal at any heading"},
    Row{Reason::goal_unseen, "goal_unseen", "the ground at the goal was not seen yet"},
    Row{Reason::goal_not_connected, "goal_not_connected",
        "no route leads to the goal, not even through unknown space"},
    Row{Reason::goal_over_stairs, "goal_over_stairs",
        "only stairs lead to the goal, which this robot does not climb"},
    Row{Reason::unknown_budget, "unknown_budget",
        "the metres towards the unseen goal are used up; go on with: mode R waypoint"},
    Row{Reason::stuck, "stuck", "no progress towards the goal"},
    Row{Reason::start_in_collision, "start_in_collision",
        "an obstacle touches the body, or nearly, and no motion leads away from it"},
    Row{Reason::tree_refused, "tree_refused",
        "the robot's behaviour tree was refused; correct the file and restart"},
    Row{Reason::odometry_jumped, "odometry_jumped",
        "the odometry jumped farther than the robot can move; set the pose with: pose R X Y YAW"},
    Row{Reason::name_taken, "name_taken", "another robot with this name was heard first; rename one of them"},
    Row{Reason::not_localised_here, "not_localised_here",
        "the robot does not recognise its surroundings after the restart; set the pose with: pose R X Y YAW"},
    Row{Reason::map_stale, "map_stale", "the map for routes is not brought up to date; see health"},
    Row{Reason::leader_unknown, "leader_unknown",
        "the robot ahead is not heard, or the leader left the convoy"},
    Row{Reason::not_in_convoy, "not_in_convoy",
        "the robot follows in no convoy; start one with convoy start"},
    Row{Reason::order_differs, "order_differs", "the robot ahead has another order; start the convoy again"},
    Row{Reason::yield_off, "yield_off", "the robot may not make way for others; allow it with: yield R on"},
    Row{Reason::yield_refused, "yield_refused", "another robot is in the way and does not make way"},
    Row{Reason::yield_deadlock, "yield_deadlock",
        "two robots block each other, and neither has a place to make way"},
    Row{Reason::no_viewpoint, "no_viewpoint",
        "nothing new can be seen from any place that the robot can reach"},
    Row{Reason::outside_area, "outside_area", "the robot may not drive there: see its areas"},
    Row{Reason::trail_impassable, "trail_impassable", "the robot cannot drive where the leader drove"},
    Row{Reason::map_empty, "map_empty", "there is no map yet"},
    Row{Reason::frame_unknown, "frame_unknown",
        "a sensor's frame is unknown; name it in the platform's sensors, or publish it on tf_static"},
    Row{Reason::sensor_times, "sensor_times", "the times of a sensor cannot be understood"},
    Row{Reason::imu_mounting, "imu_mounting", "the IMU is not mounted as the platform's file says"},
    Row{Reason::tilted, "tilted", "the robot leans so far that it may tip over; drive it down by hand"},
    Row{Reason::scan_empty, "scan_empty", "the lidar sees nothing; is it covered?"},
    Row{Reason::lidar_mounting, "lidar_mounting", "the lidar cannot be where the platform's file says"},
    Row{Reason::sensor_silent, "sensor_silent", "a sensor of the platform's file sends nothing"},
    Row{Reason::localisation_lost, "localisation_lost",
        "the odometry lost its way: the lidar does not fit what it saw before"},
    Row{Reason::type_differs, "type_differs", "a topic has another type on the other side"},
    Row{Reason::two_sources, "two_sources", "two participants send what one driver should"},
    Row{Reason::bad_argument, "bad_argument", "an argument is wrong"},
    Row{Reason::unknown_robot, "unknown_robot", "no robot of that name has been heard"},
    Row{Reason::unknown_command, "unknown_command", "no such command"},
    Row{Reason::out_of_range, "out_of_range", "a value is out of range"},
    Row{Reason::malformed, "malformed", "the message could not be decoded"},
    Row{Reason::wrong_protocol, "wrong_protocol", "the other side speaks another protocol version"},
    Row{Reason::no_answer, "no_answer", "no answer came"},
    Row{Reason::no_station, "no_station", "no station is running; start one with basestation up"},
    Row{Reason::in_use, "in_use", "already in use"},
    Row{Reason::wire_failed, "wire_failed", "the network layer failed"},
    Row{Reason::queue_full, "queue_full", "a queue is full"},
    Row{Reason::cancelled, "cancelled", "cancelled"},
    Row{Reason::cannot_read, "cannot_read", "the file cannot be read"},
    Row{Reason::cannot_write, "cannot_write", "the file cannot be written"},
    Row{Reason::syntax, "syntax", "syntax error"},
    Row{Reason::unknown_key, "unknown_key", "unknown key"},
    Row{Reason::wrong_type, "wrong_type", "wrong type"},
    Row{Reason::missing_key, "missing_key", "a key is missing"},
    Row{Reason::not_supported, "not_supported", "not supported"},
    Row{Reason::internal, "internal", "an internal error was caught"},
};

const Row* find(Reason reason) {
  for (const Row& row : kRows)
    if (row.reason == reason) return &row;
  return nullptr;
}

}  // namespace

std::string_view name(Reason reason) {
  const Row* row = find(reason);
  return row ? row->name : "unknown";
}

std::string_view describe(Reason reason) {
  const Row* row = find(reason);
  return row ? row->text : "a reason this version does not know";
}

bool reason_from_name(std::string_view text, Reason& out) {
  for (const Row& row : kRows) {
    if (row.name != text) continue;
    out = row.reason;
    return true;
  }
  return false;
}

}  // namespace adit
