// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "core/time/time.hpp"

namespace adit::bench {

/// A convoy of mixed platforms in a corridor 4 m wide with one corner. Its operator drives the leader by hand
/// along the straight part at two speeds and lets go; then the leader drives around the corner by itself, and
/// the robot behind it leaves the convoy.
struct ConvoyCourse {
  static constexpr double kGap = 1.5;                 ///< At rest, m.
  static constexpr double kHeadway = 0.8;             ///< Time that the gap grows by, s.
  static constexpr double kSlow = 0.35, kFast = 0.7;  ///< Speeds of the leader, m/s.
  static constexpr Duration kStep = 31s;              ///< The leader begins to drive at kFast.
  static constexpr Duration kLetGo = 51s;             ///< The operator lets go of the stick.
  static constexpr Duration kCorner = 57s;            ///< The leader is sent around the corner.
  static constexpr Duration kPeelOff = 88s;           ///< With three robots or more.
  static constexpr Duration kEnd = 130s;

  int robots{2};
  double noise{0.0};  ///< Scale of the errors of odometry and sensors.
  std::string link{"wifi"};
  bool full{};  ///< Full lidars instead of planar ones.

  std::string name(int robot) const { return "r" + std::to_string(robot + 1); }
  std::string platform(int robot) const;
  double length(int robot) const;  ///< Of the platform, m.
  double width(int robot) const;
  /// The rehearsal as a scenario's file has it.
  std::string scenario_text() const;
};

}  // namespace adit::bench
