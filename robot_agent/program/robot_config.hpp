#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core/config/platform.hpp"
#include "core/geometry/pose.hpp"
#include "core/log/log.hpp"
#include "core/result/result.hpp"
#include "core/wire/fastdds/fastdds_participant.hpp"
#include "robot_agent/motion/velocity_writer.hpp"
#include "robot_agent/safeguard/safeguard_params.hpp"

namespace adit::config {
class Node;
}

namespace adit::agent {

struct AgentParams;

/// `robot_interfaces`: what the robot domain uses beside loopback.
struct RobotInterfaces {
  std::vector<std::string> names{};  ///< Of network interfaces, as `ip link` lists them.
  std::string where{};               ///< "file:line" of the key, for errors.
};

/// What config/robots/NAME.yaml says; docs/configuration.md lists the keys.
struct RobotConfig {
  std::string name{};  ///< 1 to 32 of [A-Za-z0-9_-]
  Platform platform{};
  Pose2 start{};  ///< map frame: m, m, rad
  /// Height of the ground at the start, map frame, m; empty: not given.
  std::optional<double> start_height{};
  wire::FastDdsParams radio{};    ///< radio domain
  std::uint32_t robot_domain{0};  ///< of the driver, [0, 232]
  RobotInterfaces robot_interfaces{};
  VelocityType velocity{};    ///< `cmd_vel: twist` or `twist_stamped`
  Duration lock_lease{300s};  ///< 0: never
  std::string tree{"trees/robot.xml"};
  std::string state{};              ///< folder of what survives a restart; empty: the usual one; "none"
  bool resume_after_restart{true};  ///< `after_restart: resume`, else `hold`
  double memory_limit{0.0};         ///< MB that the agent may use, [0, 1e6]; 0: no limit
  SafeguardParams safeguards{};
  LogLevel log{LogLevel::info};
  std::string record{};  ///< folder of recordings, "none"; empty: below the state folder
};

/// The folder of a robot's state: the one configured, nothing for "none", else
/// $XDG_STATE_HOME/adit/robot-NAME; without that /var/lib/adit/robot-NAME for root,
/// ~/.local/state/adit/robot-NAME for others.
std::string state_folder(const RobotConfig& config);

/// Reads the keys that mean the same in a robot's file and for a robot of a scenario: cmd_vel, lock_lease,
/// start_height, tree, on_link_loss, link_loss_after, battery, after_restart. A missing key leaves `config`
/// as it is; a wrong one is noted at `node`. `file`: the tree is looked for beside it first, and becomes an
/// absolute path.
void read_robot_keys(const config::Node& node, const std::string& file, RobotConfig& config);

/// IPv4 addresses of the named interfaces, 127.0.0.1 first. Errors: bad_argument with file and line, for an
/// interface that this machine does not have, or that is down or has no IPv4 address.
Result<std::vector<std::string>> addresses_of(const RobotInterfaces& interfaces);

/// An agent's parameters as far as the file gives them: the rest (seed, log, disk, boot, handlers) is the
/// caller's.
AgentParams agent_params(const RobotConfig& config);

/// Reads it. Errors: one line with file, line and what was expected.
Result<RobotConfig> load_robot_config(const std::string& file);

}  // namespace adit::agent
