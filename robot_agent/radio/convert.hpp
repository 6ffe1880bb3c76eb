// SPDX-License-Identifier: Apache-2.0
#pragma once
// Conversions between the radio contract's generated types and the agent's. Included by .cpp files only.
#include "adit/authority.h"
#include "adit/bulk.h"
#include "adit/command.h"
#include "adit/discovery.h"
#include "adit/link.h"
#include "adit/robot.h"
#include "adit/team.h"
#include "core/config/platform.hpp"
#include "core/transfer/piece.hpp"
#include "robot_agent/behaviour/behaviour.hpp"
#include "robot_agent/command/command_interface.hpp"
#include "robot_agent/common/followed_route.hpp"
#include "robot_agent/discovery/directory.hpp"
#include "robot_agent/discovery/namesakes.hpp"

namespace adit::agent {

/// Conversion of a claim to and from the service that a robot announces while it gives way to another one of
/// its name. claim_of() returns nothing if `in` has no claim.
std::string service_word(const Namesakes::Claim& claim);
std::optional<Namesakes::Claim> claim_of(const radio::Capabilities& in);

inline radio::Epoch to_radio(const Epoch& epoch) {
  radio::Epoch out;
  out.start(epoch.start);
  out.counter(epoch.counter);
  return out;
}
inline Epoch from_radio(const radio::Epoch& epoch) { return {epoch.start(), epoch.counter()}; }

Command from_radio(const radio::Command& in, const wire::ParticipantId& sender);
StickSample from_radio(const radio::Joystick& in, const wire::ParticipantId& sender);
Peer from_radio(const radio::Capabilities& in, const wire::ParticipantId& sender);
/// Returns nothing if the beacon is malformed.
std::optional<TeamBeacon> from_radio(const radio::TeamBeacon& in);
/// What the station has of `robot`: without a receipt for it, nothing.
transfer::Ack from_radio(const radio::BulkAck& in, const std::string& robot);
radio::TeamBeacon to_radio(const TeamBeacon& beacon);

radio::PlannedRoute to_radio(const PlannedRoute& route);
/// Corners from the first one on that is too far away for the message are left out.
radio::Route to_radio(const FollowedRoute& route, const std::string& robot);
radio::Acknowledgement to_radio(const Answer& answer, const std::string& robot);
radio::Notification to_radio(const Notice& notice, const std::string& robot);
radio::AuthorityStatus to_radio(const CommandInterface& commands, const std::string& robot, Time now);
radio::BehaviourState to_radio(const BehaviourView& view, const std::vector<ModeOption>& options,
                               const std::string& robot);
radio::Capabilities to_radio(const Platform& platform, const std::string& robot, const Id& id,
                             std::uint16_t protocol, const ModeTable& modes);

}  // namespace adit::agent
