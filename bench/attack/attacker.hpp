// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <netinet/in.h>

#include <atomic>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/wire/link_state.hpp"
#include "tests/wire/rtps_messages.hpp"

namespace adit::bench {

/// Somebody on the radio network who speaks RTPS: a participant that announces itself, learns the endpoints
/// of the others, and sends whatever it likes in its own name or theirs.
class Attacker {
 public:
  using Bytes = wire::test::Bytes;

  explicit Attacker(unsigned domain);
  ~Attacker();
  Attacker(const Attacker&) = delete;
  Attacker& operator=(const Attacker&) = delete;

  const wire::ParticipantId& id() const { return id_; }
  /// The unicast address at which it receives, as a locator.
  Bytes own_locator() const { return wire::test::locator("127.0.0.5", port_); }
  /// Announces itself.
  void announce();
  /// Sends to the group and to both ports of each participant on this machine.
  void to_all(const Bytes& message);
  /// Entity id of the writer of that topic of that participant, as it was announced to us.
  std::optional<std::uint32_t> writer(const wire::ParticipantId& of, const std::string& topic) const;
  /// Bytes that it and an uninvolved receiver at 127.0.0.9 received since the last call.
  std::pair<std::uint64_t, std::uint64_t> received();
  /// The port of the uninvolved receiver.
  std::uint16_t victim_port() const { return victim_port_; }

 private:
  void listen(int socket, std::atomic<std::uint64_t>& bytes, bool learn);
  void learn(const std::vector<std::uint8_t>& message);
  /// Asks a participant for the endpoints that its heartbeat announces.
  void request(const wire::ParticipantId& from, std::uint64_t first, std::uint64_t last);

  wire::ParticipantId id_{};
  unsigned domain_;
  int socket_{-1}, victim_{-1};
  std::uint16_t port_{}, victim_port_{};
  std::atomic<bool> ends_{false};
  std::atomic<std::uint64_t> received_{0}, victim_received_{0};
  std::uint32_t requests_{};
  mutable std::mutex mutex_{};
  std::map<std::pair<wire::ParticipantId, std::string>, std::uint32_t> writers_{};
  std::thread listener_{}, victim_listener_{};
};

}  // namespace adit::bench
