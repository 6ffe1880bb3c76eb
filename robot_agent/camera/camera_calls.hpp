// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/component/call.hpp"
#include "core/contract/camera.hpp"
#include "core/geometry/pose.hpp"
#include "core/transfer/piece.hpp"

/// The calls between the command component and the component `cameras`, which run on different strands.
namespace adit::agent {

/// A single good picture that a station asked for.
struct TakenShot {
  transfer::PeerId station{};
  std::uint32_t number{};  ///< As the station asked for it.
  std::string camera{};
  std::uint64_t stamp{};              ///< Exposure by the driver's clock, ns; 0: unknown.
  std::uint32_t age{};                ///< Time from the exposure to the coding, ms.
  std::optional<Pose3> T_map_base{};  ///< Pose of the body at the exposure.
  std::vector<std::uint8_t> jpeg{};
};

/// What a station looks at of this robot's cameras; none: nothing new, only the answer is wanted.
struct CameraOrder {
  std::optional<transfer::PeerId> station{};
  std::vector<contract::CameraView> views{};
  std::uint64_t got{};  ///< CameraAnswer::batch of the last answer that arrived.
};
/// The pictures that were taken and did not arrive at the command component yet.
struct CameraAnswer {
  std::vector<TakenShot> shots{};
  std::uint64_t batch{};  ///< Of these pictures; they come again until an order names it.
  bool active{};          ///< Some station looks, or a picture is still being taken.
};
/// Offered by the component `cameras`.
using CameraService = Service<CameraOrder, CameraAnswer>;

/// A time by the driver's clock, ns; 0: the driver stamps nothing.
struct PlaceQuery {
  std::uint64_t stamp{};
  Time received{};  ///< When the message with that stamp came.
};
/// Where the robot was at that time.
struct PlaceThen {
  std::optional<Pose3> T_map_base{};  ///< Nothing: the pose is not known.
  Duration age{};                     ///< Time since then.
  bool foreign_clock{};  ///< The stamp is far from those of the odometry; `age` is then that of the message.
};
/// Offered by the command component.
using PlaceService = Service<PlaceQuery, PlaceThen>;

}  // namespace adit::agent
