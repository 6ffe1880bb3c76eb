// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <string_view>
#include <vector>

#include "core/result/reason.hpp"

namespace adit::agent {

/// The state of the robot by which the conditions of its modes are evaluated.
struct Facts {
  bool stopped{};       ///< A software stop is set.
  bool driver_alive{};  ///< Odometry arrived within the last 0.5 s.
  /// The start pose is known, odometry was received, and the place is not far inside forbidden ground.
  bool localised{};
  bool terrain_fresh{};  ///< Lidar points arrived within the last 0.5 s.
  bool stick_fresh{};    ///< A stick sample arrived within the last 0.3 s.
  bool stick_present{};  ///< A stick sample arrived within the last 1 s: the manual mode may continue.
  bool stick_centred{};  ///< The last stick sample requests zero velocity.
  bool goal_known{};
  bool goal_free{};      ///< No known obstacle covers the goal.
  bool program_fresh{};  ///< The program that steers in `external` sent a velocity within the last 0.5 s.
  bool map_fresh{};      ///< The router answered a scan of the last 2 s.
  /// Names of further facts that hold, for conditions of additional modes; the mode's module adds them.
  std::vector<std::string_view> also{};
  Reason unlocalised{Reason::no_localisation};  ///< Why the robot is not localised, if it is not.

  bool has(std::string_view fact) const { return std::find(also.begin(), also.end(), fact) != also.end(); }
};

}  // namespace adit::agent
