// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/config/perception_level.hpp"
#include "core/geometry/pose.hpp"
#include "core/result/reason.hpp"
#include "core/time/time.hpp"
#include "core/wire/participant.hpp"

/// What an outsider can know of one robot: the samples that reached it, the samples it sent, and what the
/// simulated world did. Plain copies of the radio types, so that the rules need no generated code.
namespace adit::sim {

using StationId = std::array<std::uint8_t, 16>;

struct Authority {
  std::uint64_t start{};    ///< Epoch: random id of this start of the agent.
  std::uint32_t counter{};  ///< Epoch: its counter.
  std::string holder{};     ///< Empty: none.
  StationId holder_id{};
  bool locked{};
  bool operator==(const Authority&) const = default;
};

/// Who stopped the robot: name and id.
struct Latch {
  std::string station{};
  StationId id{};
  bool operator==(const Latch&) const = default;
};

enum class Verb {
  take,
  release,
  lock,
  unlock,
  grant,
  stop,
  reset,
  mode,   ///< Also `explore`, with that mode as the text.
  go_to,  ///< Also `home`, which has no position.
  query,
  restart,      ///< Restarts the component named in the text.
  policy,       ///< Sets the restart policy of a component.
  plan,         ///< Asks the global planner for a route.
  pose,         ///< Sets the pose of the robot.
  join,         ///< Gives the robot its place in a convoy; the words are the names in their order.
  peeloff,      ///< Takes the robot out of its convoy.
  yield,        ///< Allows the robot to make way; the text is on or off.
  area_add,     ///< The words are its name and its kind, the numbers its corners, then two heights.
  area_remove,  ///< The text is its name.
  unknown       ///< A number that the checker does not know.
};

/// The agent's process began to run as that participant of the radio domain.
struct AgentStarted {
  wire::ParticipantId participant{};
};
struct AgentDied {};
/// A fault was put into that component of the agent: one of its callbacks throws, or does not return.
struct ComponentFaulted {
  std::string component{};
};
/// Nothing fits on the robot's disk, or again.
struct DiskChanged {
  bool full{};
};

// Received by the robot -------------------------------------------------------------------------------
/// Presence or Capabilities of a station.
struct PresenceHeard {
  wire::ParticipantId from{};
  std::string station{};
  StationId id{};
};
struct CommandHeard {
  wire::ParticipantId from{};
  std::string station{};
  StationId id{};
  std::uint64_t start{};    ///< Start id of the epoch it was given under.
  std::uint32_t counter{};  ///< Counter of that epoch.
  std::uint64_t seq{};
  Verb verb{Verb::query};
  std::string text{};
  bool flag{};
  std::optional<std::array<double, 2>> position{};  ///< Goal of goto, map frame, m.
  std::vector<std::string> words{};
  std::vector<double> numbers{};
  std::uint16_t options{};  ///< Bit i: option i of the command was given.
};
struct JoystickHeard {
  wire::ParticipantId from{};
  StationId id{};
  std::uint64_t start{};
  std::uint32_t counter{};
  std::uint64_t seq{};
  std::uint64_t echo{};  ///< Robot's clock, ns.
  Twist2 stick{};
};

/// A beacon of another robot reached the robot.
struct BeaconHeard {
  std::string robot{};
  std::vector<std::string> asks{};  ///< The robots that it asks to make way.
};

/// A scan of its lidar reached the robot.
struct ScanHeard {};
/// A sample of its driver's odometry reached the robot.
struct OdometryHeard {
  Pose2 pose{};  ///< Odometry frame.
};
/// A velocity of the program that steers in mode `external` reached the robot.
struct ProgramHeard {
  Twist2 velocity{};  ///< Body frame.
};

// Sent by the robot -----------------------------------------------------------------------------------
struct AckSent {
  std::string station{};
  StationId id{};
  std::uint64_t seq{};  ///< 0: of a refused stream
  bool accepted{};
  Reason reason{Reason::none};
  std::string text{};
  std::string holder{};
  std::uint64_t start{};
  std::uint32_t counter{};
};
/// Another robot of the same name answered a command.
struct NamesakeAnswered {
  StationId id{};
  std::uint64_t seq{};
  bool accepted{};
};
struct AuthoritySent {
  Authority authority{};
  std::vector<Latch> stops{};
};
struct BehaviourSent {
  std::string mode{};
  bool stopped{};
  bool has_goal{};
  bool drives_to_goal{};  ///< It has not reached it, and its mode uses it.
  std::uint32_t goal_id{};
  Reason reason{Reason::none};        ///< Why it does not move.
  std::vector<std::string> convoy{};  ///< The robots of its convoy in their order.
  int exploration{};                  ///< Value of radio::ExplorationPhase.
};
struct StateSent {
  std::uint64_t stamp{};  ///< Robot's clock, ns.
  Pose3 pose{};           ///< Its own estimate, map frame, level.
  double sigma{};         ///< Standard deviation of its position as it states it, m; infinite: none.
  Localisation localisation{Localisation::off};
};
struct NotificationSent {
  std::string code{};
  std::string to{};  ///< Operator; empty: all.
  std::uint64_t seq{};
  Reason reason{Reason::none};
};
/// cmd_vel, from the agent or from its parent process.
struct VelocitySent {
  Twist2 velocity{};
};

// What the world did ----------------------------------------------------------------------------------
struct Motion {
  Pose2 pose{};       ///< World frame.
  Twist2 velocity{};  ///< Body frame.
};

/// The robot's clock went on by so much at once.
struct ClockJumped {
  Duration by{};
};

using Event = std::variant<AgentStarted, AgentDied, PresenceHeard, CommandHeard, JoystickHeard, AckSent,
                           AuthoritySent, BehaviourSent, StateSent, NotificationSent, VelocitySent, Motion,
                           ClockJumped, ComponentFaulted, DiskChanged, ScanHeard, ProgramHeard, OdometryHeard,
                           NamesakeAnswered, BeaconHeard>;

/// What the outsider knows of a robot's body beforehand.
struct RobotFacts {
  std::string name{};
  double max_acceleration{1.0};       ///< m/s2
  double max_turn_acceleration{3.0};  ///< rad/s2
  double lock_lease{300.0};           ///< Lease of a lock, s; 0: it never lapses.
  double length{}, width{};           ///< Of its footprint, m; 0: not known.
  bool knows_its_place{};             ///< Its odometry has no error, so its own pose is the true one.
};

}  // namespace adit::sim
