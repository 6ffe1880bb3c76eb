#pragma once
#include <cstdint>
#include <string_view>

namespace adit {

/// Why something was refused or failed. The numbers travel on the wire and are shown to operators:
/// a number is never reused. The names are what scenarios and scripts compare (`refused: locked`).
enum class Reason : std::uint16_t {
  none = 0,

  // Authority (rules 1 to 4)
  not_holder = 101,         ///< the sender does not hold the robot
  locked = 102,             ///< the robot is locked by its holder
  stale_epoch = 103,        ///< the command was given under an earlier authority
  stale_sequence = 104,     ///< the sequence number is older than one already seen
  unknown_station = 105,    ///< the sender has not announced itself as a basestation
  name_in_use = 106,        ///< another station with this name is being heard
  identity_mismatch = 107,  ///< the name is the holder's, the participant or station id is not
  nobody_holds = 108,       ///< the command needs a holder and there is none
  unknown_operator = 109,   ///< the operator named in the command has not been heard
  stop_of_another = 110,    ///< the stop was set by another station: reset --override clears it
  wrong_robot = 111,        ///< the command is addressed to another robot

  // Conditions of the modes (rules 5 to 7)
  stopped = 201,             ///< a software stop is set
  joystick_stale = 202,      ///< no fresh joystick sample
  stick_not_centred = 203,   ///< a manual mode starts from a centred stick
  driver_silent = 204,       ///< the driver has not been heard
  no_localisation = 205,     ///< localisation is not initialised
  terrain_stale = 206,       ///< no fresh obstacle points
  goal_missing = 207,        ///< the mode needs a goal and there is none
  goal_unreachable = 208,    ///< the goal lies in an obstacle or outside what can be reached
  mode_unknown = 209,        ///< no mode of that name
  mode_not_installed = 210,  ///< this robot has no module for that mode
  sample_stale = 211,        ///< the echoed stamp is too old
  wrong_mode = 212,          ///< the current mode does not take this input
  blocked = 213,             ///< every path is blocked
  program_silent = 214,      ///< the program that steers from outside has not been heard
  obstacle_close = 215,      ///< the collision monitor holds the robot back
  just_restarted = 216,      ///< a stop may be under way to the agent that was started a moment ago
  tree_refused = 226,        ///< The behaviour tree contradicts the mode table; the robot runs in hold.
  odometry_jumped = 227,     ///< The driver's odometry moved farther than the body can.
  name_taken = 228,          ///< Another robot with the same name was there first.

  // What was typed or sent
  bad_argument = 301,
  unknown_robot = 302,
  unknown_command = 303,
  out_of_range = 304,
  malformed = 305,       ///< a message could not be decoded
  wrong_protocol = 306,  ///< the other side speaks another protocol version

  // Programs and wire
  no_answer = 401,
  no_station = 402,
  in_use = 403,  ///< a name, port or socket is taken
  wire_failed = 404,
  queue_full = 405,
  cancelled = 406,

  // Files
  cannot_read = 501,
  cannot_write = 502,
  syntax = 503,
  unknown_key = 504,
  wrong_type = 505,
  missing_key = 506,
  not_supported = 507,

  internal = 901,  ///< an exception was caught at a boundary; the text says which
};

/// The name of a reason, as scenarios and scripts write it; "reason_<number>" is never returned:
/// an unknown number reads "unknown".
std::string_view name(Reason reason);
/// The sentence an operator reads when no better text came with the reason.
std::string_view describe(Reason reason);
/// The reason of that name; Reason::internal and false when there is none.
bool reason_from_name(std::string_view text, Reason& out);

}  // namespace adit
