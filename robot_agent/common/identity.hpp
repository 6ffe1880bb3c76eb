#pragma once
#include <array>
#include <cstdint>
#include <string>

#include "core/command/words.hpp"
#include "core/wire/participant.hpp"

namespace adit::agent {

/// Version of the radio contract.
inline constexpr std::uint16_t kProtocolVersion = 1;

/// 128 random bits kept on the owner's disk.
using Id = std::array<std::uint8_t, 16>;

/// Name and id that a message states, and the participant that really sent it.
struct Sender {
  std::string name{};
  Id id{};
  wire::ParticipantId participant{};
};

/// 1 to 32 of [A-Za-z0-9_-], for robots and stations.
using command::valid_name;

}  // namespace adit::agent
