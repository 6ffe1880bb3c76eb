// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core/config/perception_level.hpp"
#include "core/config/platform.hpp"
#include "core/geometry/pose.hpp"
#include "core/log/log.hpp"
#include "core/result/result.hpp"
#include "core/wire/fastdds/fastdds_participant.hpp"
#include "robot_agent/findings/detection.hpp"
#include "robot_agent/motion/velocity_writer.hpp"
#include "robot_agent/safeguard/safeguard_params.hpp"

namespace adit::config {
class Node;
}

namespace adit::agent {

struct AgentParams;

/// The key `robot_interfaces`: network interfaces that the robot domain uses beside loopback.
struct RobotInterfaces {
  std::vector<std::string> names{};  ///< Names as `ip link` lists them.
  std::string where{};               ///< "file:line" of the key, for errors.
};

/// The contents of config/robots/NAME.yaml; docs/configuration.md lists the keys.
struct RobotConfig {
  std::string name{};  ///< See command::valid_robot_name().
  Platform platform{};
  Pose2 start{};  ///< Map frame; m, m, rad.
  /// Height of the ground at the start, map frame, m; unset: not given.
  std::optional<double> start_height{};
  wire::FastDdsParams radio{};    ///< Radio domain.
  std::uint32_t robot_domain{0};  ///< Domain of the driver, [0, 232].
  RobotInterfaces robot_interfaces{};
  VelocityType velocity{};  ///< `cmd_vel: twist` or `twist_stamped`
  PerceptionLevel perception{PerceptionLevel::off};
  bool carry_maps{false};  ///< `map: {carry: true}`
  DetectionParams detections{};
  ReportParams reports{};
  std::optional<ObjectsParams> objects{};  ///< Nothing: without the key.
  Duration lock_lease{300s};               ///< 0: never
  std::string tree{"trees/robot.xml"};
  std::string state{};  ///< Folder of the state that survives a restart; empty: the default folder; "none":
                        ///< no state is stored.
  bool resume_after_restart{true};  ///< `after_restart: resume`, else `hold`
  double memory_limit{0.0};         ///< Maximum memory of the agent, MB, [0, 1e6]; 0: no limit.
  SafeguardParams safeguards{};
  LogLevel log{LogLevel::info};
  std::string record{};  ///< Folder of recordings; empty: below the state folder; "none": no recording.
};

/// The folder of a robot's state: the configured one, an empty string for "none", otherwise
/// $XDG_STATE_HOME/adit/robot-NAME; without that /var/lib/adit/robot-NAME for root,
/// ~/.local/state/adit/robot-NAME for others.
std::string state_folder(const RobotConfig& config);

/// Reads the keys that a robot's file and a scenario have in common: cmd_vel, lock_lease,
/// perception, map, detections, reports, objects, start_height, tree, on_link_loss, link_loss_after, battery,
/// after_restart. A missing key leaves `config` as it is; a wrong one is noted at `node`. The tree is
/// searched first in the folder of `file`, and becomes an absolute path.
void read_robot_keys(const config::Node& node, const std::string& file, RobotConfig& config);

/// IPv4 addresses of the named interfaces, 127.0.0.1 first. Errors: bad_argument with file and line, for an
/// interface that does not exist on this computer, is down or has no IPv4 address.
Result<std::vector<std::string>> addresses_of(const RobotInterfaces& interfaces);

/// Makes the agent's parameters from the file; the caller sets the others (seed, log, disk, boot, handlers).
AgentParams agent_params(const RobotConfig& config);

/// Loads a robot's file. Errors: one line with file, line and the expected value.
Result<RobotConfig> load_robot_config(const std::string& file);

}  // namespace adit::agent
