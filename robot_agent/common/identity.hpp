// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <string>

#include "core/command/words.hpp"
#include "core/wire/participant.hpp"

namespace adit::agent {

/// Version of the radio contract.
inline constexpr std::uint16_t kProtocolVersion = 1;

/// 128 random bits stored on the owner's disk.
using Id = std::array<std::uint8_t, 16>;

/// Name and id that a message states, and the participant that sent it.
struct Sender {
  std::string name{};
  Id id{};
  wire::ParticipantId participant{};
};

/// Names of robots and stations: 1 to 32 characters of [A-Za-z0-9_-].
using command::valid_name;

}  // namespace adit::agent
