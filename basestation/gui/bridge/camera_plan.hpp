// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "basestation/model/network.hpp"
#include "basestation/model/world.hpp"

namespace adit::gui {

/// Robot and camera.
using CameraName = std::pair<std::string, std::string>;

/// How a camera takes part in the grid of all cameras.
enum class CameraRole : std::uint8_t {
  sharp,      ///< Shown large: asked for its full size.
  thumbnail,  ///< Asked for a small size at a low rate.
  waits,      ///< For its turn, or for the end of another picture.
  refused,    ///< The link profile leaves no room for it.
  off,        ///< The operator switched it off.
  lost,       ///< Its robot is lost.
};

/// A camera of the grid, and what is asked of it.
struct PlannedCamera {
  CameraName name{};
  CameraRole role{CameraRole::waits};
  bool sharp{};           ///< It is the one that is shown large, whatever its role.
  std::uint16_t width{};  ///< Largest width of a thumbnail, pixels; 0: as wide as it is shown.
  float rate{};           ///< Pictures/s that are asked for; 0: none are.
  std::string why{};      ///< Why none are, for the operator; empty for roles that ask.
  float bytes{};          ///< Bytes/s that arrive.
  bool operator==(const PlannedCamera&) const = default;
};

/// What the plan depends on.
struct CameraPlanScene {
  const station::World* world{};
  const station::NetworkReport* net{};  ///< Null, or without reports: nothing is known of the links yet.
  CameraName sharp{};
  std::set<CameraName> off{};
  /// Those whose thumbnail is in sight; null: all. The others ask for nothing, and wait for no turn.
  const std::multiset<CameraName>* in_sight{};
  std::size_t turn{};  ///< Rises with time: thumbnails for which there is no room take turns.
};

/// The cameras of all robots, and how the pictures of the grid share the link.
struct CameraPlan {
  std::vector<PlannedCamera> cameras{};  ///< By robot, each robot's in its order.
  std::vector<std::string> without{};    ///< Robots that have no camera.
  std::string summary{};                 ///< What the thumbnails cost, and how many wait, in a sentence.
};

/// At most so many thumbnails are asked for at once. With the sharp camera and those of other panes, they
/// stay below the 16 cameras that a station looks at.
inline constexpr std::size_t kMaxThumbnails = 12;
/// The same where thumbnails take turns: the station holds those of the turn before for some seconds more.
inline constexpr std::size_t kMaxInTurns = 6;

/// Plans the grid. The sharp camera comes first: thumbnails share a quarter of what the station's link
/// profile has for pictures, each at least one picture in 10 s; those that do not fit take turns. A robot
/// shares its link equally among its cameras, so on a limited link the sharp one has its robot's link alone.
CameraPlan camera_plan(const CameraPlanScene& scene);

}  // namespace adit::gui
