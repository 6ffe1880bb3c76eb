// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "core/config/perception_level.hpp"
#include "core/contract/common.hpp"
#include "core/result/reason.hpp"

/// Plain values that a station reports to its front ends. Positions are in the map frame (m, rad), speeds in
/// the body frame (m/s, rad/s), ages in s.
namespace adit::station {

using contract::Epoch;

/// A mode, and why it could not be entered now (`none`: it could).
struct ModeChoice {
  std::string mode{};
  bool available{};
  Reason reason{Reason::none};
  bool operator==(const ModeChoice&) const = default;
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
  bool operator==(const ExplorationView&) const = default;
};

/// A part of the map where a robot may drive or not, or that it prefers to explore.
struct AreaView {
  static constexpr float kAnyHeight = std::numeric_limits<float>::infinity();
  std::string name{};
  std::string kind{};                           ///< keep_in, keep_out or prefer.
  std::vector<std::array<float, 2>> corners{};  ///< Of a polygon, map frame, m.
  float z_min{-kAnyHeight}, z_max{kAnyHeight};  ///< Heights, m; infinite: at any height.
  float weight{1.0F};                           ///< Of an area to prefer.
  bool operator==(const AreaView&) const = default;
};

/// The route over the ground that a robot follows.
struct RouteView {
  static constexpr std::size_t kMaxCorners = 32;  ///< Of `points`.

  std::uint32_t goal_id{};  ///< As in its robot.
  /// Its first corners, from where the robot was when it sent them, map frame, m; empty: no route is
  /// followed.
  std::vector<std::array<float, 3>> points{};
  std::uint32_t unknown{};  ///< Bit i: the leg from corner i leads through space that was not seen.
  std::uint16_t corners{};  ///< Of the complete route.
  bool operator==(const RouteView&) const = default;
};

/// The bounding box of a robot's body, m; 0: unknown.
struct Size {
  float length{};  ///< Along x of the body frame.
  float width{};
  float height{};
  bool operator==(const Size&) const = default;
};

/// One robot as its station knows it.
struct Robot {
  std::string name{};
  double age{};  ///< Time since its last state, s.
  bool lost{};   ///< Neither state nor heartbeat for 2.5 s.

  bool described{};  ///< Its capabilities were received: the values up to `services`.
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
  std::vector<std::string> sensors{};
  std::vector<std::string> services{};

  bool located{};  ///< A state was received: the values up to `sigma`.
  float x{}, y{}, z{}, yaw{};
  float vx{}, vy{}, wz{};
  float roll{}, pitch{};  ///< Of the body, rad (REP-103).
  std::uint8_t
      map_revision{};    ///< Changes when its place in the map was corrected: earlier places were moved.
  float battery{-1.0F};  ///< State of charge, [0, 1]; negative: unknown.
  Localisation localisation{Localisation::off};
  double sigma{};  ///< Standard deviation of the position as the robot states it, m; 0 with `off`.

  Epoch epoch{};
  std::string holder{};  ///< Empty: no holder.
  bool mine{};           ///< This station holds it.
  bool locked{};
  float lease_left{-1.0F};           ///< In s; negative: no lease runs.
  std::vector<std::string> stops{};  ///< Stations that set a software stop.
  bool stopped_by_holder{};          ///< One of them is the holder.

  std::string mode{};
  bool stopped{};
  bool moving_allowed{};
  Reason reason{Reason::none};  ///< Why the robot does not move.
  GoalPhase goal_phase{GoalPhase::none};
  std::uint32_t goal_id{};
  std::array<double, 3> goal{};  ///< Unless the phase is `none`; z is NaN where the ground is meant.
  RouteView route{};
  ExplorationView exploration{};
  std::vector<ModeChoice> choices{};
  bool yields{};                      ///< It may make way for other robots.
  std::string yields_to{};            ///< The robot for which it makes way; empty: none.
  std::vector<std::string> convoy{};  ///< The robots of its convoy in their order; empty: it is in none.
  std::vector<AreaView> areas{};
  std::vector<std::string> troubles{};  ///< Components that do not work, with their state.
};

/// Whether a stick drives the robot in that mode.
bool is_by_hand(std::string_view mode);

const char* to_string(GoalPhase phase);
const char* to_string(ExplorationPhase phase);

}  // namespace adit::station
