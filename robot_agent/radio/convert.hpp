// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/config/platform.hpp"
#include "core/contract/authority.hpp"
#include "core/contract/command.hpp"
#include "core/contract/discovery.hpp"
#include "robot_agent/behaviour/behaviour.hpp"
#include "robot_agent/command/command_interface.hpp"

namespace adit::agent {

/// Returns the received message as the command strand handles it, with the participant that sent it.
Command received(contract::Command message, const wire::ParticipantId& sender);

contract::AuthorityStatus status_of(const CommandInterface& commands, const std::string& robot, Time now);
contract::Capabilities capabilities_of(const Platform& platform, const std::string& robot, const Id& id,
                                       std::uint16_t protocol, const ModeTable& modes);

}  // namespace adit::agent
