// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/contract/common.hpp"

namespace adit::radio {
class LinkReport;
}

/// The traffic of an agent (idl/adit/link.idl). Received amounts are finite and not negative.
namespace adit::contract {

/// Traffic of one topic at one agent: bytes/s with all headers, and samples/s.
struct TopicTraffic {
  static constexpr std::size_t kMaxTopic = 64;  ///< Of a received topic's name, bytes.

  std::string topic{};
  float bytes_out{}, samples_out{}, bytes_in{}, samples_in{};
  std::uint32_t dropped{};  ///< Failed writes and malformed samples since the start of the agent.
  bool operator==(const TopicTraffic&) const = default;
};

/// How well an agent hears another one, by its heartbeats.
struct PeerLink {
  std::string peer{};      ///< A valid name.
  std::uint32_t number{};  ///< Of the newest heartbeat that was received.
  double held{};           ///< Time since then, s, [0, 1e6).
  float lost{};            ///< Lost share of the last ones, [0, 1].
  bool operator==(const PeerLink&) const = default;
};

/// What an agent sends and receives, and the state of its sender.
struct LinkReport {
  static constexpr std::size_t kMaxTopics = 16, kMaxPeers = 16;
  static constexpr std::size_t kPriorities = 7;

  std::string agent{};
  float discovery_out{}, discovery_in{}, total_out{}, total_in{};  ///< Bytes/s.
  std::vector<TopicTraffic> topics{};                              ///< Sorted; of more, the first are sent.
  std::uint32_t malformed{};                                       ///< Malformed samples since its start.
  std::vector<PeerLink> peers{};                     ///< For a robot: the stations that it hears.
  std::string link{};                                ///< Link profile; empty: nothing limits it.
  double bandwidth{};                                ///< In bit/s; 0: unknown.
  double queue{};                                    ///< Queued airtime without bulk and video, s.
  std::array<std::uint32_t, kPriorities> dropped{};  ///< Messages never sent since its start, by priority.
  double state_rate{};                               ///< Rate of RobotState, Hz; 0: it sends none.
  bool operator==(const LinkReport&) const = default;
};

radio::LinkReport encode(const LinkReport& report);
/// Returns nothing for an agent whose name is not valid. Peers with a malformed link are left out.
std::optional<LinkReport> decode(const radio::LinkReport& sample);

}  // namespace adit::contract
