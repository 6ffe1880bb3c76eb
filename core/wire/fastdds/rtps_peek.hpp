#pragma once
#include <cstdint>
#include <optional>
#include <span>

#include "core/wire/link_state.hpp"

namespace adit::wire {

/// What the outside of an RTPS message tells, without trusting it.
struct RtpsPeek {
  std::optional<std::uint32_t> writer{};       ///< entity id of the first sample's writer, if it carries one
  bool whole{};                                ///< that sample is alone and no fragment
  std::optional<ParticipantId> source{};       ///< who sent the message
  std::optional<ParticipantId> destination{};  ///< whom its first part is for, if it is for one alone
};

/// Reads the submessage headers of an RTPS 2 message. Nothing in it when it is none or is cut short.
RtpsPeek peek(std::span<const std::uint8_t> message);

}  // namespace adit::wire
