// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

/// RTPS port numbers: 7400 + 250 * domain + {0: discovery by multicast, 1: data by multicast,
/// 10 + 2 n: discovery, 11 + 2 n: data of participant n}.
namespace adit::wire {

inline bool is_discovery_port(std::uint32_t port) { return port >= 7400 && (port - 7400) % 250 % 2 == 0; }
/// Maps both ports of a participant to one number.
inline std::uint32_t participant_of_port(std::uint32_t port) { return port & ~1U; }

}  // namespace adit::wire
