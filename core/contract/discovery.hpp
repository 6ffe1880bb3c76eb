// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/contract/common.hpp"

namespace adit::radio {
class Capabilities;
class Presence;
}  // namespace adit::radio

namespace adit::contract {

/// Version of the radio contract that a station or robot announces.
inline constexpr std::uint16_t kProtocolVersion = 1;

enum class AgentKind : std::uint8_t { robot, station };

/// Words in Capabilities::services.
namespace service {
inline constexpr const char* kRoute = "route";               ///< It plans routes.
inline constexpr const char* kTilt = "tilt";                 ///< RobotState has roll and pitch.
inline constexpr const char* kMapRevision = "map_revision";  ///< RobotState has the map's revision.
inline constexpr const char* kTurnOnSpot = "turn_on_spot";
inline constexpr const char* kStairs = "stairs";
inline constexpr const char* kFlight = "flight";
inline constexpr const char* kCarryMap = "carry_map";  ///< It carries maps of other robots on to stations.
}  // namespace service

/// Whether a word is one of the services.
bool offers(const std::vector<std::string>& services, std::string_view word);

/// What a robot announces while it gives way to another one of its name: one of its services.
struct NameClaim {
  bool held{};
  std::uint64_t start{};  ///< Id of the start of its command component, as in its epoch.
  bool operator==(const NameClaim&) const = default;
};

std::string service_word(const NameClaim& claim);
/// Returns nothing if a robot with these services does not give way.
std::optional<NameClaim> claim_of(const std::vector<std::string>& services);

/// What a robot or a station is, and what it can do.
struct Capabilities {
  static constexpr std::size_t kMaxSensors = 16, kMaxModes = 32, kMaxServices = 32;

  std::string name{};
  AgentKind kind{AgentKind::robot};
  Id id{};
  std::uint16_t protocol{};
  std::string software{};  ///< Version.
  std::string platform{};  ///< Name of the platform: wheeled, tracked, legged, ...; empty for a station.
  bool holonomic{};        ///< It can also move sideways.
  float length{}, width{}, height{};  ///< Of the body, m; 0: unknown.
  float max_speed{};                  ///< m/s
  float max_turn{};                   ///< rad/s
  float max_acceleration{};           ///< In m/s2; 0: unknown.
  float max_step{};                   ///< Maximum height of a step, m; 0: none.
  float max_slope{};                  ///< In rad; 0: unknown.
  bool stairs{};                      ///< It can climb stairs.
  std::vector<std::string> sensors{}, modes{}, services{};
  std::optional<std::array<float, 3>> place{};  ///< Of a station, map frame, m; unset: unknown.
  bool operator==(const Capabilities&) const = default;
};

radio::Capabilities encode(const Capabilities& capabilities);
/// The first amount that is outside its limits, and these, as text; "" when there is none.
std::string amount_refused(const radio::Capabilities& sample);
/// Returns nothing if the name is not valid. Words are cleaned; amounts outside their limits are 0, unknown:
/// no limit of a robot and no distance from another one follows from a length in millimetres.
std::optional<Capabilities> decode(const radio::Capabilities& sample);

/// Heartbeat of a robot or a station.
struct Presence {
  std::string name{};
  AgentKind kind{AgentKind::robot};
  Id id{};
  std::uint16_t protocol{};
  std::uint32_t seq{};
  bool operator==(const Presence&) const = default;
};

radio::Presence encode(const Presence& presence);
/// Returns nothing if the name is not valid.
std::optional<Presence> decode(const radio::Presence& sample);

}  // namespace adit::contract
