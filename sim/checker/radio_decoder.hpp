// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "sim/checker/observation.hpp"

namespace adit::sim {

/// A sample of the radio or robot domain, decoded, and the robot that it names (empty: none does).
struct DecodedSample {
  std::string robot{};
  Event event{};
};

/// Decodes what a robot receives: Presence, Capabilities of a station, Command, Joystick; scans and the
/// velocities of a program on its own domain. Nothing for other topics and for bytes that are no sample.
std::optional<DecodedSample> decode_received(std::string_view topic, std::span<const std::uint8_t> cdr,
                                             const wire::ParticipantId& from);
/// Decodes what a robot sends: acknowledgements, its states, notifications, cmd_vel. `type`: the DDS type,
/// for cmd_vel has two.
std::optional<DecodedSample> decode_sent(std::string_view topic, std::string_view type,
                                         std::span<const std::uint8_t> cdr);

}  // namespace adit::sim
