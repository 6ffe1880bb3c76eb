// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "basestation/model/outcome.hpp"
#include "core/contract/link.hpp"
#include "core/result/result.hpp"

namespace adit::station {

using contract::TopicTraffic;

/// What an agent sends and receives, bytes/s.
struct AgentTraffic {
  std::string agent{};
  double age{};  ///< Of its report, s.
  float discovery_out{}, discovery_in{}, total_out{}, total_in{};
  std::uint32_t malformed{};  ///< Malformed samples since its start.
  std::vector<TopicTraffic> topics{};
  std::map<std::string, double> classes_out{};  ///< Bytes/s that it sends, by traffic class and "discovery".
  std::map<std::string, double> hears{};  ///< Fraction of heartbeats that it misses, [0, 1], by their sender.
  bool operator==(const AgentTraffic&) const = default;
};

/// An agent's own report of its sender.
struct SenderReport {
  std::string link{};                              ///< Link profile; empty: the traffic is not limited.
  double bandwidth{};                              ///< In bit/s; 0: unknown.
  double queue{};                                  ///< Queued airtime without bulk and video, s.
  double state_rate{};                             ///< Rate of RobotState, Hz.
  std::map<std::string, std::uint32_t> dropped{};  ///< Messages never sent since its start, by priority.
  bool operator==(const SenderReport&) const = default;
};

/// The link between this station and one agent.
struct LinkReport {
  std::string agent{};
  double age{};                                    ///< Time since its last heartbeat, s.
  double lost_from{};                              ///< Fraction of its heartbeats that were lost, [0, 1].
  std::optional<double> lost_to{};                 ///< Fraction of this station's that it missed.
  std::optional<double> round_trip{};              ///< In s.
  std::optional<double> bytes_from{}, bytes_to{};  ///< Bytes/s.
  std::optional<double> signal{};                  ///< dBm
  std::optional<SenderReport> sender{};            ///< Unset before its first report.
  bool operator==(const LinkReport&) const = default;
};

/// The answer to `net`.
struct NetworkReport {
  std::vector<AgentTraffic> agents{};
  std::vector<LinkReport> links{};
  std::optional<SenderReport> sender{};  ///< This station's own.
  bool operator==(const NetworkReport&) const = default;
};

/// Reads the outcome of `net`. Errors: as of health_of().
Result<NetworkReport> network_of(const CommandOutcome& outcome);

}  // namespace adit::station
