// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "core/wire/link.hpp"
#include "core/wire/participant.hpp"

namespace adit::wire {

/// Parameters of one Fast DDS participant. Without interfaces, nothing leaves the machine.
struct FastDdsParams {
  std::uint32_t domain{77};               ///< DDS domain, [0, 232]
  std::string name{"adit"};               ///< Participant name, for people.
  std::vector<std::string> interfaces{};  ///< Addresses to use; empty: only 127.0.0.1.
  std::vector<std::string> peers{};  ///< ADDRESS or ADDRESS:PORT of peers, for networks without multicast.
  bool multicast{true};              ///< Look for peers by multicast.
  /// For a robot domain: scans pass between processes of one robot in datagrams of up to 65 kB, and the
  /// receive buffers are large enough for them. Otherwise datagrams stay below 1400 bytes, as a radio
  /// requires. The library's shared memory is never used: after a process was killed, its peers may write
  /// into the dead segment for ever (Fast-DDS #4728).
  bool large_samples{false};
  /// Link that everything sent passes: its bandwidth, priorities and budgets, and, if it has them, its
  /// latency and losses. Without a link, datagrams go straight to the sockets; those of a radio domain are
  /// queued by priority while the sockets are full.
  std::optional<LinkProfile> link{};
  std::uint64_t link_seed{1};  ///< Seed of losses and jitter.
};

/// Opens the participant. Errors: wire_failed (with what to do), bad_argument.
///
/// Fast DDS has two settings that affect the entire process. Its environment: ROS_DISCOVERY_SERVER,
/// FASTRTPS_DEFAULT_PROFILES_FILE, FASTDDS_ENVIRONMENT_FILE and FASTDDS_STATISTICS are removed from it, and a
/// file DEFAULT_FASTRTPS_PROFILES.xml is not loaded; call this before other threads read the environment.
/// Delivery inside the process: it is switched off, also between other participants of a program that embeds
/// this wire, which then communicate through their transports.
Result<std::unique_ptr<Participant>> open_fastdds(const FastDdsParams& params);

}  // namespace adit::wire
