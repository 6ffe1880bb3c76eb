// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "basestation/model/camera.hpp"
#include "core/contract/common.hpp"
#include "core/contract/robot.hpp"

/// Plain values that a station reports to its front ends. Positions are in the map frame (m, rad), speeds in
/// the body frame (m/s, rad/s), ages in s.
namespace adit::station {

using contract::Epoch;

using contract::ExplorationPhase;
using contract::GoalState;
using contract::ModeOption;
using contract::RecoveryState;

/// The bounding box of a robot's body, m; 0: unknown.
struct Size {
  float length{};  ///< Along x of the body frame.
  float width{};
  float height{};
  bool operator==(const Size&) const = default;
};

/// One robot as its station knows it: its last messages, and what the station adds.
struct Robot : contract::RobotState, contract::BehaviourState {
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

  bool located{};  ///< A RobotState was received.

  Epoch epoch{};
  std::string holder{};  ///< Empty: no holder.
  bool mine{};           ///< This station holds it.
  bool locked{};
  float lease_left{-1.0F};           ///< In s; negative: no lease runs.
  std::vector<std::string> stops{};  ///< Stations that set a software stop.
  bool stopped_by_holder{};          ///< One of them is the holder.

  std::vector<CameraStatus> cameras{};  ///< As it names them.
  contract::Route route{};
  std::vector<std::string> troubles{};  ///< Components that do not work, with their state.
};

/// Whether a stick drives the robot in that mode.
bool is_by_hand(std::string_view mode);

}  // namespace adit::station
