// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <string>

#include "robot_agent/behaviour/behaviour.hpp"
#include "robot_agent/command/authority.hpp"
#include "robot_agent/discovery/peer_table.hpp"
#include "robot_agent/motion/frames.hpp"
#include "robot_agent/notices/notices.hpp"
#include "robot_agent/safeguard/battery_return.hpp"
#include "robot_agent/safeguard/safeguard_params.hpp"

namespace adit::agent {

/// Acts without an operator when the link to the holder is lost or the battery is nearly empty (rule 9).
/// Only autonomous modes are changed. Runs on the command strand.
class Safeguards {
 public:
  /// The objects that the safeguards watch and act on; they must outlive the safeguards.
  struct Dependencies {
    const Authority& authority;
    const PeerTable& peers;
    Behaviour& behaviour;
    const Frames& frames;
    const Notices& notices;
  };

  /// `robot`: name of the robot. `start`: its start pose, map frame.
  Safeguards(SafeguardParams params, std::string robot, const Pose2& start, const Dependencies& dependencies);

  /// Restores the state that stored() returned before a restart.
  void restore(std::uint8_t stored, Time now);
  /// The state that must survive a restart: the last threshold that was passed, and whether a return is still
  /// pending. See Snapshot::battery.
  std::uint8_t stored() const;
  /// Checks the link to the holder, and repeats a refused return. Call it once a second.
  void tick(Time now);
  /// Processes a new state of charge, [0, 1]; a value that is not finite counts as unknown.
  void battery(float charge, Time now);
  /// State of charge, [0, 1]; negative while unknown.
  float charge() const { return charge_; }

 private:
  void watch_link(Time now);
  void battery_fell(BatteryLevel level, Time now);
  /// Attempts the return to the start that is pending because of the battery, if it is due.
  void watch_return(Time now);
  Result<void> go_back(const Eigen::Vector2d& place, const std::string& why, Time now);

  SafeguardParams params_;
  std::string robot_;
  Pose2 start_;
  Dependencies dependencies_;
  LinkLoss link_loss_;
  BatteryWatch battery_watch_;
  BatteryReturn battery_return_;
  float charge_{-1.0f};
};

}  // namespace adit::agent
