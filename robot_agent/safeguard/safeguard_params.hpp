// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "robot_agent/safeguard/battery_watch.hpp"
#include "robot_agent/safeguard/link_loss.hpp"

namespace adit::agent {

/// The actions of a robot that loses the link to its holder, or whose battery is nearly empty.
struct SafeguardParams {
  LinkLossParams link_loss{};  ///< Its `start` is the robot's start pose.
  BatteryParams battery{};
  /// Pause from a refused return to the next attempt, > 0; doubles each time up to
  /// BatteryReturn::kLongestPause.
  Duration return_retry{1s};
  bool return_at_last_battery{};  ///< At the last threshold: true drives back to the start, false holds.
};

}  // namespace adit::agent
