// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "core/command/words.hpp"
#include "core/contract/discovery.hpp"
#include "core/wire/participant.hpp"

namespace adit::agent {

using contract::Id;
using contract::kProtocolVersion;

/// Name and id that a message states, and the participant that sent it.
struct MessageSender {
  std::string name{};
  Id id{};
  wire::ParticipantId participant{};
};

/// Names of stations, modes and areas: 1 to 32 characters of [A-Za-z0-9_-]; for robots see
/// valid_robot_name().
using command::valid_name;

}  // namespace adit::agent
