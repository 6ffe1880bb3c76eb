// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/config/perception_level.hpp"
#include "core/contract/common.hpp"
#include "core/geometry/area.hpp"
#include "core/result/reason.hpp"
#include "core/supervisor/part_state.hpp"

namespace adit::radio {
class RobotState;
class Route;
class BehaviourState;
class Notification;
class Health;
}  // namespace adit::radio

/// The state messages of a robot (idl/adit/robot.idl). Poses are in the map frame (m, rad), speeds in the
/// body frame (m/s, rad/s); received ones are as they were sent and may be not finite. decode() returns
/// nothing for a robot whose name is not valid. The sender's number of a message (`seq`) is no part of its
/// value. A received reason may be one of a later version.
namespace adit::contract {

struct RobotState {
  static constexpr double kMaxSigma = 65.535;       ///< m
  static constexpr double kMaxTilt = 3.2;           ///< rad
  static constexpr double kSigmaPerMetre = 1000.0;  ///< `sigma` is sent in mm,
  static constexpr double kTiltPerRadian = 1000.0;  ///< `roll` and `pitch` in mrad.

  std::string robot{};
  std::uint64_t stamp{};  ///< The robot's clock, to be echoed by sticks.
  float x{}, y{}, z{}, yaw{};
  float vx{}, vy{}, wz{};
  float battery{-1.0F};    ///< State of charge, [0, 1]; negative: unknown.
  double sigma{};          ///< Standard deviation of the position, [0, kMaxSigma]; 0 with Localisation::off.
  double roll{}, pitch{};  ///< Of the body, rad, [-kMaxTilt, kMaxTilt] (REP-103).
  Localisation localisation{Localisation::off};
  /// Changes when the robot's place in the map was corrected: earlier places were moved.
  std::uint8_t map_revision{};
  bool operator==(const RobotState&) const = default;
};

/// The rest of the route over the ground that a robot follows.
struct Route {
  static constexpr std::size_t kMaxCorners = 32;    ///< Of `points`; more are not sent.
  static constexpr double kOffsetsPerMetre = 10.0;  ///< Points after the first are sent in dm from it.

  std::string robot{};
  std::uint32_t goal_id{};  ///< As in BehaviourState.
  std::size_t corners{};    ///< Of the complete rest, [0, 65535]; 0: the robot follows no route.
  std::vector<Eigen::Vector3d> points{};  ///< Its first corners, from the robot on; empty without a route.
  std::uint32_t unknown{};  ///< Bit i: the leg from corner i leads through space that was not seen.
  bool operator==(const Route&) const = default;
};

/// A mode and whether it could be entered now.
struct ModeOption {
  std::string mode{};
  bool available{};
  Reason reason{Reason::none};  ///< Why it is not available.
  bool operator==(const ModeOption&) const = default;
};

enum class GoalState : std::uint8_t { none, kept, active, blocked, reached };

constexpr std::string_view to_string(GoalState state) {
  constexpr std::string_view kNames[]{"none", "kept", "active", "blocked", "reached"};
  return kNames[static_cast<std::size_t>(state)];
}

enum class ExplorationPhase : std::uint8_t {
  none,        ///< The robot did not explore yet, or was taken from it.
  starting,    ///< There was no goal yet.
  exploring,   ///< On the way to a place nearby.
  travelling,  ///< On the way to a distant place.
  reporting,   ///< Nothing is left to explore: on the way home or to where the holder is heard.
  done,        ///< Everything that can be reached was seen.
  ended,       ///< It ended before that.
};

constexpr std::string_view to_string(ExplorationPhase phase) {
  constexpr std::string_view kNames[]{"none",      "starting", "exploring", "travelling",
                                      "reporting", "done",     "ended"};
  return kNames[static_cast<std::size_t>(phase)];
}

/// What a robot explored.
struct Exploration {
  ExplorationPhase phase{ExplorationPhase::none};
  Reason reason{Reason::none};  ///< Why it ended.
  float volume{};               ///< Volume that was seen, m3.
  float share{};                ///< Share of that volume in itself and what is expected to be left, [0, 1].
  std::uint16_t open{};         ///< Frontiers to which a route leads.
  std::uint16_t unreachable{};  ///< Frontiers to which none leads.
  bool operator==(const Exploration&) const = default;
};

/// What a robot does about what is in its way.
enum class RecoveryState : std::uint8_t { drive, wait, nudge, back_up, replan, give_up };

constexpr std::string_view to_string(RecoveryState state) {
  constexpr std::string_view kNames[]{"drive", "wait", "nudge", "back_up", "replan", "give_up"};
  return kNames[static_cast<std::size_t>(state)];
}

struct BehaviourState {
  static constexpr std::size_t kMaxOptions = 16, kMaxConvoy = 8, kMaxAreas = 16;

  std::string robot{};
  std::string mode{};
  bool stopped{};
  bool moving_allowed{};
  Reason reason{Reason::none};  ///< Why the robot does not move.
  RecoveryState recovery{RecoveryState::drive};
  GoalState goal_state{GoalState::none};
  std::uint32_t goal_id{};                        ///< Rises with every accepted goal.
  Eigen::Vector3d goal{Eigen::Vector3d::Zero()};  ///< z is NaN where the ground is meant.
  std::vector<ModeOption> options{};
  std::vector<std::string> convoy{};  ///< The robots of its convoy in their order; empty: it is in none.
  bool yields{};                      ///< Its holder allowed it to make way for other robots.
  std::string yields_to{};            ///< The robot for which it makes way; empty: none.
  Exploration exploration{};
  /// Where the robot may drive or not, or what it prefers to explore. Malformed ones are left out.
  std::vector<Area> areas{};
  bool operator==(const BehaviourState&) const = default;
};

enum class Severity : std::uint8_t { info, warning, error };

constexpr std::string_view to_string(Severity severity) {
  constexpr std::string_view kNames[]{"info", "warning", "error"};
  return kNames[static_cast<std::size_t>(severity)];
}

/// A notification for operators.
struct Notification {
  static constexpr std::size_t kMaxSentText = 500;  ///< Bytes; the topic has no room for more.

  std::string operator_name{};  ///< The operator concerned; empty: all operators.
  Severity severity{Severity::info};
  std::string code{};
  Reason reason{Reason::none};
  std::string text{};
  std::string robot{};
  std::uint64_t stamp{};  ///< Time of the event by the robot's clock, as in RobotState; 0: unknown.
  bool operator==(const Notification&) const = default;
};

/// A component of a robot, or a part of it that has none (driver, disk).
struct ComponentHealth {
  static constexpr std::size_t kMaxSentText = 200;  ///< Bytes.

  std::string name{};
  PartState state{PartState::starting};
  bool healthy{};
  bool automatic{};    ///< Restarts automatically.
  float silent_for{};  ///< Time since its last heartbeat, s, not negative.
  std::uint32_t restarts{};
  std::uint32_t hung{};  ///< Number of threads that it left behind.
  std::string text{};    ///< Why it failed, or a remark.
  bool operator==(const ComponentHealth&) const = default;
};

struct Health {
  static constexpr std::size_t kMaxComponents = 32;

  std::string robot{};
  std::vector<ComponentHealth> components{};
  bool operator==(const Health&) const = default;
};

radio::RobotState encode(const RobotState& state);
/// Corners from the first one on that is too far away for the message are left out.
radio::Route encode(const Route& route);
radio::BehaviourState encode(const BehaviourState& state);
radio::Notification encode(const Notification& notification);
radio::Health encode(const Health& health);

std::optional<RobotState> decode(const radio::RobotState& sample);
/// A route from a place that is not finite is none.
std::optional<Route> decode(const radio::Route& sample);
std::optional<BehaviourState> decode(const radio::BehaviourState& sample);
std::optional<Notification> decode(const radio::Notification& sample);
std::optional<Health> decode(const radio::Health& sample);

}  // namespace adit::contract
