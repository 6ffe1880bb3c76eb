// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string_view>

namespace adit {

/// Reason why something was refused or failed. The numbers travel on the wire and are shown to operators; a
/// number is never reused. Scenarios and scripts compare the names (`refused: locked`).
enum class Reason : std::uint16_t {
  none = 0,

  // Authority (rules 1 to 4)
  not_holder = 101,       ///< The sender has no authority over the robot.
  locked = 102,           ///< The robot is locked by the station with authority.
  stale_epoch = 103,      ///< The command was given under an earlier authority epoch.
  stale_sequence = 104,   ///< The sequence number is older than one already received.
  unknown_station = 105,  ///< The sender has not announced itself as a basestation.
  name_in_use = 106,      ///< Another station with this name is present.
  /// The name is that of the station with authority; the participant or station id is not.
  identity_mismatch = 107,
  nobody_holds = 108,      ///< The command needs a station with authority and there is none.
  unknown_operator = 109,  ///< The operator named in the command has not been heard.
  stop_of_another = 110,   ///< The stop was set by another station: reset --override clears it.
  wrong_robot = 111,       ///< The command is addressed to another robot.
  would_go_on = 112,       ///< Robots that the station holds would move on without a holder.

  // Conditions of the modes (rules 5 to 7)
  stopped = 201,             ///< A software stop is set.
  joystick_stale = 202,      ///< There is no recent joystick sample.
  stick_not_centred = 203,   ///< A manual mode starts only from a centred stick.
  driver_silent = 204,       ///< The driver has not been heard.
  no_localisation = 205,     ///< Localisation is not initialised.
  terrain_stale = 206,       ///< There are no recent obstacle points.
  goal_missing = 207,        ///< The mode needs a goal and there is none.
  goal_unreachable = 208,    ///< The goal is in an obstacle or cannot be reached.
  mode_unknown = 209,        ///< There is no mode of that name.
  mode_not_installed = 210,  ///< This robot has no module for that mode.
  sample_stale = 211,        ///< The echoed stamp is too old.
  wrong_mode = 212,          ///< The current mode does not accept this input.
  blocked = 213,             ///< Every path is blocked.
  program_silent = 214,      ///< The external program that steers has not been heard.
  obstacle_close = 215,      ///< The collision monitor stops the robot.
  just_restarted = 216,      ///< A stop may be in transit to the agent, which has just started.
  goal_occupied = 217,       ///< Something stands where the robot is to stand.
  goal_no_floor = 218,       ///< The ground is missing there.
  goal_too_steep = 219,      ///< The ground there is too steep, or a step.
  goal_too_narrow = 220,     ///< The robot does not fit there at any heading.
  goal_unseen = 221,         ///< The ground there was not seen yet: accepted, driven within a budget.
  goal_not_connected = 222,  ///< No route leads there, not even through unknown space.
  unknown_budget = 223,      ///< The budget of metres towards a goal that was not seen is used up.
  stuck = 224,               ///< No progress along the route to the goal for a long time.
  start_in_collision = 225,  ///< An obstacle touches the body, or nearly, and no motion leads away from it.
  tree_refused = 226,        ///< The behaviour tree contradicts the mode table; the robot runs in hold.
  odometry_jumped = 227,     ///< The driver's odometry moved farther than the body can.
  name_taken = 228,          ///< Another robot of the same name was present first.
  /// After a restart the robot does not find its place in its map: `pose R X Y YAW`.
  not_localised_here = 229,
  map_stale = 230,          ///< The router has not taken a scan into its map for 2 s.
  leader_unknown = 231,     ///< The leader left the convoy, or the robot ahead is not heard.
  not_in_convoy = 232,      ///< The robot has no place in a convoy.
  order_differs = 233,      ///< The robot ahead has another order of the convoy.
  yield_off = 234,          ///< The holder did not allow the robot to make way for others.
  yield_refused = 235,      ///< A robot in the way does not make way.
  yield_deadlock = 236,     ///< Neither of two robots that meet can make way.
  no_viewpoint = 237,       ///< There is no place from which the robot could see anything new.
  outside_area = 238,       ///< The place is outside of the areas where the robot may drive.
  trail_impassable = 239,   ///< The robot cannot drive where the leader drove.
  map_empty = 241,          ///< There is no map yet.
  frame_unknown = 242,      ///< Neither the platform's file nor tf_static knows the frame of a message.
  sensor_times = 243,       ///< The times of a sensor's message cannot be understood.
  imu_mounting = 244,       ///< The IMU does not measure gravity where its mounting says.
  tilted = 245,             ///< The body leans so far that it may tip over.
  scan_empty = 246,         ///< A scan without any return.
  lidar_mounting = 247,     ///< The lidar cannot be where its mounting says.
  sensor_silent = 248,      ///< A sensor of the platform's file sends nothing, or has another clock.
  localisation_lost = 249,  ///< The odometry does not know where the robot is.
  type_differs = 250,       ///< A topic has another type on the other side.
  two_sources = 251,        ///< Two participants write what one driver should.
  goal_over_stairs = 252,   ///< Only stairs lead there, which the robot does not climb.

  // Input that was typed or sent.
  bad_argument = 301,
  unknown_robot = 302,
  unknown_command = 303,
  out_of_range = 304,
  malformed = 305,       ///< A message could not be decoded.
  wrong_protocol = 306,  ///< The other side uses another protocol version.

  // Programs and wire.
  no_answer = 401,
  no_station = 402,
  in_use = 403,  ///< A name, port or socket is taken.
  wire_failed = 404,
  queue_full = 405,
  cancelled = 406,

  // Files.
  cannot_read = 501,
  cannot_write = 502,
  syntax = 503,
  unknown_key = 504,
  wrong_type = 505,
  missing_key = 506,
  not_supported = 507,

  internal = 901,  ///< An exception was caught at a boundary; the text says which.
};

/// Returns the name of a reason, as scenarios and scripts write it; "unknown" for an unknown number.
std::string_view name(Reason reason);
/// Returns the sentence for the operator when the reason comes without a more specific text.
std::string_view describe(Reason reason);
/// Parses the name of a reason; sets Reason::internal and returns false when there is none of that name.
bool reason_from_name(std::string_view text, Reason& out);

}  // namespace adit
