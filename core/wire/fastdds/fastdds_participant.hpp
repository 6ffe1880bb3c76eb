#pragma once
#include <optional>

#include "core/wire/link.hpp"
#include "core/wire/participant.hpp"

namespace adit::wire {

/// One Fast DDS participant. With no interface named, nothing leaves the machine.
struct FastDdsParams {
  std::uint32_t domain{77};               ///< DDS domain, [0, 232]
  std::string name{"adit"};               ///< participant name, for people
  std::vector<std::string> interfaces{};  ///< addresses to use; empty: 127.0.0.1 alone
  std::vector<std::string> peers{};  ///< ADDRESS or ADDRESS:PORT of others, for networks without multicast
  bool multicast{true};              ///< ask for others by multicast
  /// Robot domain: scans pass between processes of one robot in datagrams of up to 65 kB, and there is room
  /// for them at the receiver; without it datagrams stay below 1400 bytes, as a radio wants them. Never
  /// through the library's shared memory: after a process was killed, who wrote to it may write into the dead
  /// one's for ever (Fast-DDS #4728).
  bool large_samples{false};
  /// A link that all that is sent passes: its bandwidth, priorities and budgets, and, where it says so, its
  /// latency and losses. Without one datagrams go straight to the sockets, and those of a radio domain wait
  /// by priority while these have no room.
  std::optional<LinkProfile> link{};
  std::uint64_t link_seed{1};  ///< of losses and jitter
};

/// Opens the participant. Errors: wire_failed (with what to do), bad_argument.
///
/// Fast DDS has two settings that are the whole process's. Its environment: ROS_DISCOVERY_SERVER,
/// FASTRTPS_DEFAULT_PROFILES_FILE, FASTDDS_ENVIRONMENT_FILE and FASTDDS_STATISTICS are removed from it, and a
/// file DEFAULT_FASTRTPS_PROFILES.xml is not loaded; call this before other threads read the environment.
/// Delivery inside the process: it is switched off, also between other participants of a program that embeds
/// this wire, which then talk through their transports.
Result<std::unique_ptr<Participant>> open_fastdds(const FastDdsParams& params);

}  // namespace adit::wire
