// SPDX-License-Identifier: Apache-2.0
#pragma once
// Conversions between the radio contract's generated types and the agent's. Included by .cpp files only.
#include "adit/link.h"
#include "adit/robot.h"
#include "core/config/platform.hpp"
#include "robot_agent/behaviour/behaviour.hpp"
#include "robot_agent/command/command_interface.hpp"
#include "robot_agent/common/followed_route.hpp"
#include "robot_agent/discovery/directory.hpp"

namespace adit::agent {

/// Returns the received message as the command strand handles it, with the participant that sent it.
Command received(contract::Command message, const wire::ParticipantId& sender);

contract::AuthorityStatus status_of(const CommandInterface& commands, const std::string& robot, Time now);
contract::Capabilities capabilities_of(const Platform& platform, const std::string& robot, const Id& id,
                                       std::uint16_t protocol, const ModeTable& modes);

/// Corners from the first one on that is too far away for the message are left out.
radio::Route to_radio(const FollowedRoute& route, const std::string& robot);
radio::Notification to_radio(const Notice& notice, const std::string& robot);
radio::BehaviourState to_radio(const BehaviourView& view, const std::vector<ModeOption>& options,
                               const std::string& robot);

}  // namespace adit::agent
