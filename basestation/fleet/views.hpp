#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "basestation/fleet/links.hpp"
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

/// A mode, and why it could not be entered now (none: it could).
struct ModeChoice {
  std::string mode{};
  bool available{};
  Reason reason{Reason::none};
};

enum class GoalPhase : std::uint8_t { none, kept, active, blocked, reached };

enum class ComponentPhase : std::uint8_t { starting, up, waiting, failed, hung };

struct ComponentView {
  std::string name{};
  ComponentPhase phase{ComponentPhase::starting};
  bool healthy{};
  bool automatic{};    ///< restarted without being asked
  float silent_for{};  ///< s
  std::uint32_t restarts{};
  std::uint32_t hung{};  ///< threads that it left behind
  std::string text{};
};

/// The box around a robot's body, m; 0: not known.
struct Size {
  float length{};  ///< along x of the body frame
  float width{};
  float height{};
};

/// All that was heard of one robot. Positions in the map frame (m, rad), speeds in the body frame (m/s,
/// rad/s).
struct RobotView {
  std::string name{};
  wire::ParticipantId participant{};
  Time first_heard{};
  Time last_heard{};  ///< last RobotState, or the first sign of life before that
  Time spoke{};       ///< last sample of any kind
  Time last_sign{};   ///< of life, by what it says once a second beside its RobotStates
  bool lost{false};   ///< neither for 2.5 s

  bool described{false};  ///< capabilities were heard
  std::string platform{};
  std::string software{};
  std::uint16_t protocol{};
  float max_speed{};         ///< m/s
  float max_turn{};          ///< rad/s
  float max_acceleration{};  ///< m/s2; 0: not known
  bool holonomic{};          ///< moves sideways, too
  Size size{};
  float max_step{};      ///< height of a step that it climbs, m; 0: none
  float max_slope{};     ///< rad; 0: not known
  bool climbs_stairs{};  ///< takes stairs
  std::vector<std::string> modes{};
  std::vector<std::string> sensors{};
  std::vector<std::string> services{};

  bool located{false};    ///< a RobotState was heard
  std::uint64_t stamp{};  ///< the robot's clock, as it is to be echoed
  wire::ParticipantId stamped_by{};
  float x{}, y{}, z{}, yaw{};
  float vx{}, vy{}, wz{};
  float battery{-1.0F};  ///< 0..1; negative: not known

  bool owned{false};  ///< an AuthorityStatus was heard
  Epoch epoch{};
  std::string holder{};  ///< empty: nobody
  Id holder_id{};
  bool locked{};
  float lease_left{-1.0F};  ///< s; negative: no lease runs
  std::vector<StopLatch> stops{};

  std::uint64_t behaviour_count{};  ///< BehaviourStates heard; 0: none yet
  std::string mode{};
  bool stopped{};
  bool moving_allowed{};
  Reason reason{Reason::none};  ///< why it does not move
  GoalPhase goal_phase{GoalPhase::none};
  std::uint32_t goal_id{};
  std::array<double, 3> goal{};
  std::vector<ModeChoice> choices{};

  std::vector<ComponentView> components{};
};

struct StationView {
  std::string name{};
  Id id{};
  wire::ParticipantId participant{};
  Time last_heard{};
  std::optional<std::array<float, 3>> place{};  ///< where it stands, map frame, m; nothing: not known
};

enum class Level : std::uint8_t { info, warning, error };

/// Something an operator should know, from a robot or from this station (lost, back).
struct Notice {
  std::uint64_t id{};  ///< unique in this run of the station, rising from 1; it never changes
  Time at{};           ///< when it arose, by this station's clock
  std::string robot{};
  std::string operator_name{};  ///< whom it concerns; empty: everybody
  Level level{Level::info};
  std::string code{};
  Reason reason{Reason::none};
  std::string text{};
  bool mine{};  ///< concerns this operator
  /// Until the robot's clock is known, `at` is when this was heard; then it is made earlier.
  std::optional<std::uint64_t> undated{};  ///< the robot's stamp
  wire::ParticipantId said_by{};
};

/// Bytes and samples a second of one topic at one agent.
struct TopicRate {
  std::string topic{};
  float bytes_out{}, samples_out{}, bytes_in{}, samples_in{};
  std::uint32_t dropped{};  ///< since its start
};

struct TrafficView {
  std::string agent{};
  Time last_heard{};
  float discovery_out{}, discovery_in{}, total_out{}, total_in{};  ///< bytes a second
  std::uint32_t malformed{};                                       ///< samples since its start
  std::vector<TopicRate> topics{};
  SenderView sender{};
  float lost_there{-1.0F};  ///< share of our signs of life that the agent missed; negative: not known
};

const char* to_string(GoalPhase phase);
const char* to_string(Level level);

}  // namespace adit::station
