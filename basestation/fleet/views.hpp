// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "basestation/fleet/links.hpp"
#include "core/config/perception_level.hpp"
#include "core/result/reason.hpp"
#include "core/time/time.hpp"
#include "core/wire/participant.hpp"

namespace adit::station {

using Id = std::array<std::uint8_t, 16>;

struct Epoch {
  std::uint64_t start{};
  std::uint32_t counter{};
  bool operator==(const Epoch&) const = default;
};

/// One latch of the software stop.
struct StopLatch {
  std::string station{};
  Id station_id{};
};

/// A mode, and why it could not be entered now (`none`: it could).
struct ModeChoice {
  std::string mode{};
  bool available{};
  Reason reason{Reason::none};
};

enum class GoalPhase : std::uint8_t { none, kept, active, blocked, reached };

/// States of an exploration, as in radio::ExplorationPhase.
enum class ExplorationPhase : std::uint8_t { none, starting, exploring, travelling, reporting, done, ended };

/// What a robot explored, as it reports.
struct ExplorationView {
  ExplorationPhase phase{ExplorationPhase::none};  ///< `none`: it did not explore.
  Reason reason{Reason::none};                     ///< Why it ended.
  float volume{};                                  ///< Volume that was seen, m3.
  float share{};                   ///< Share of that in itself and what is expected to be left, [0, 1].
  unsigned open{}, unreachable{};  ///< Frontiers to which a route leads, and to which none leads.
};

/// A part of the map where a robot may drive or not, or that it prefers to explore.
struct AreaView {
  std::string name{};
  std::string kind{};                           ///< keep_in, keep_out or prefer.
  std::vector<std::array<float, 2>> corners{};  ///< Of a polygon, map frame, m.
  float z_min{}, z_max{};                       ///< Heights, m; infinite: at any height.
  float weight{1.0F};                           ///< Of an area to prefer.
};

enum class ComponentPhase : std::uint8_t { starting, up, waiting, failed, hung };

struct ComponentView {
  std::string name{};
  ComponentPhase phase{ComponentPhase::starting};
  bool healthy{};
  bool automatic{};    ///< Restarts automatically.
  float silent_for{};  ///< In s.
  std::uint32_t restarts{};
  std::uint32_t hung{};  ///< Number of threads that it left behind.
  std::string text{};
};

/// The bounding box of a robot's body, m; 0: unknown.
struct Size {
  float length{};  ///< Along x of the body frame.
  float width{};
  float height{};
};

/// The state of one robot as received. Positions are in the map frame (m, rad), speeds in the body frame
/// (m/s, rad/s).
struct RobotView {
  std::string name{};
  wire::ParticipantId participant{};
  Time first_heard{};
  Time last_heard{};  ///< Last RobotState, or the first heartbeat before that.
  Time spoke{};       ///< Last sample of any kind.
  Time last_sign{};   ///< Last heartbeat, sent once a second beside RobotState.
  bool lost{false};   ///< Neither RobotState nor heartbeat for 2.5 s.

  bool described{false};  ///< Capabilities were received.
  std::string platform{};
  std::string software{};
  std::uint16_t protocol{};
  float max_speed{};         ///< m/s
  float max_turn{};          ///< rad/s
  float max_acceleration{};  ///< In m/s2; 0: unknown.
  bool holonomic{};          ///< It can also move sideways.
  Size size{};
  float max_step{};      ///< Maximum height of a step, m; 0: none.
  float max_slope{};     ///< In rad; 0: unknown.
  bool climbs_stairs{};  ///< It can climb stairs.
  std::vector<std::string> modes{};
  std::vector<std::string> sensors{};
  std::vector<std::string> services{};

  bool located{false};    ///< A RobotState was received.
  std::uint64_t stamp{};  ///< Stamp of the robot's clock, to be echoed.
  wire::ParticipantId stamped_by{};
  float x{}, y{}, z{}, yaw{};
  float vx{}, vy{}, wz{};
  float battery{-1.0F};  ///< State of charge, [0, 1]; negative: unknown.
  Localisation localisation{Localisation::off};
  double sigma{};  ///< Standard deviation of the position as the robot states it, m.

  bool owned{false};  ///< An AuthorityStatus was received.
  Epoch epoch{};
  std::string holder{};  ///< Empty: no holder.
  Id holder_id{};
  bool locked{};
  float lease_left{-1.0F};  ///< In s; negative: no lease runs.
  std::vector<StopLatch> stops{};

  std::uint64_t behaviour_count{};  ///< Number of BehaviourStates received.
  std::string mode{};
  bool stopped{};
  bool moving_allowed{};
  Reason reason{Reason::none};  ///< Why the robot does not move.
  GoalPhase goal_phase{GoalPhase::none};
  std::uint32_t goal_id{};
  std::array<double, 3> goal{};
  ExplorationView exploration{};
  std::vector<ModeChoice> choices{};
  bool yields{};                      ///< It may make way for other robots.
  std::string yields_to{};            ///< The robot for which it makes way; empty: none.
  std::vector<std::string> convoy{};  ///< The robots of its convoy in their order; empty: it is in none.
  std::vector<AreaView> areas{};

  std::vector<ComponentView> components{};
};

struct StationView {
  std::string name{};
  Id id{};
  wire::ParticipantId participant{};
  Time last_heard{};
  std::optional<std::array<float, 3>> place{};  ///< Position of the station, map frame, m; unset: unknown.
};

enum class Level : std::uint8_t { info, warning, error };

/// A notification for operators, from a robot or from this station (lost, back).
struct Notice {
  std::uint64_t id{};  ///< Unique in this run of the station, rising from 1; never changes.
  Time at{};           ///< Time of the event, by this station's clock.
  std::string robot{};
  std::string operator_name{};  ///< The operator concerned; empty: all operators.
  Level level{Level::info};
  std::string code{};
  Reason reason{Reason::none};
  std::string text{};
  bool mine{};  ///< It concerns this operator.
  /// Set while the robot's clock is unknown: `at` is then the time of reception, and is moved back to the
  /// event later.
  std::optional<std::uint64_t> undated{};  ///< Stamp of the robot's clock.
  wire::ParticipantId said_by{};
};

/// Bytes/s and samples/s of one topic at one agent.
struct TopicRate {
  std::string topic{};
  float bytes_out{}, samples_out{}, bytes_in{}, samples_in{};
  std::uint32_t dropped{};  ///< Since its start.
};

struct TrafficView {
  std::string agent{};
  Time last_heard{};
  float discovery_out{}, discovery_in{}, total_out{}, total_in{};  ///< Bytes/s.
  std::uint32_t malformed{};                                       ///< Malformed samples since its start.
  std::vector<TopicRate> topics{};
  SenderView sender{};
  float lost_there{
      -1.0F};  ///< Fraction of this station's heartbeats that the agent missed, [0, 1]; negative: unknown.
};

const char* to_string(GoalPhase phase);
const char* to_string(ExplorationPhase phase);
const char* to_string(Level level);

}  // namespace adit::station
