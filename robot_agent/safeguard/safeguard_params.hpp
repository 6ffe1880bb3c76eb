#pragma once
#include "robot_agent/safeguard/battery_watch.hpp"
#include "robot_agent/safeguard/link_loss.hpp"

namespace adit::agent {

/// What a robot does by itself when it loses the link to its holder, or its battery is nearly empty.
struct SafeguardParams {
  LinkLossParams link_loss{};  ///< Its `start` is the robot's start pose.
  BatteryParams battery{};
  /// From a return that was refused to the next attempt, then twice as long each time up to
  /// BatteryReturn::kLongestPause. > 0
  Duration return_retry{1s};
  bool return_at_last_battery{};  ///< At the last threshold: true drives back to the start, false holds.
};

}  // namespace adit::agent
