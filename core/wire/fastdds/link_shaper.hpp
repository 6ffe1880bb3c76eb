// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <netinet/in.h>

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "core/wire/fastdds/udp_sender.hpp"
#include "core/wire/link/model.hpp"
#include "core/wire/link/transmit_queue.hpp"
#include "core/wire/link_state.hpp"

namespace adit::wire {

/// The transmit queue between a participant and its sockets. With a link profile it is the link model:
/// datagrams leave by priority, within their budget, at the link's bandwidth, and arrive late or are lost.
/// Without one, datagrams go straight to the sockets; those that a socket has no room for, as when a real
/// radio is full, are queued by priority and retried. It runs one thread and has its own sockets, so that
/// queued datagrams do not depend on the library's lifetime.
class LinkShaper {
 public:
  /// Functions that the shaper calls from any thread; each may be empty.
  struct Outputs {
    /// Called when a datagram was transmitted.
    std::function<void(std::span<const std::uint8_t> message, in_addr_t address, std::uint16_t port)> sent{};
    /// Returns the path (distance and walls) to the peer at that address.
    std::function<Path(in_addr_t address, std::uint16_t port)> path{};
  };
  /// Sends a datagram on a socket and never blocks; returns false when the socket has no room now.
  using Socket =
      std::function<bool(std::span<const std::uint8_t> message, in_addr_t address, std::uint16_t port)>;

  /// `seed`: of losses and jitter. `interfaces`: addresses on which multicast is sent.
  LinkShaper(std::optional<LinkProfile> link, std::uint64_t seed, const std::vector<std::string>& interfaces,
             Outputs outputs);
  LinkShaper(std::optional<LinkProfile> link, std::uint64_t seed, Socket socket, Outputs outputs);
  ~LinkShaper();
  LinkShaper(const LinkShaper&) = delete;
  LinkShaper& operator=(const LinkShaper&) = delete;

  /// Sets how a writer's samples are sent: their priority, and whether the newest sample replaces queued ones
  /// (for a keyed topic, those of the same key).
  void add_writer(std::uint32_t entity, int priority, bool newest_wins, bool keyed = false);
  void remove_writer(std::uint32_t entity);

  /// Queues a datagram to an IPv4 address (network order) and port. Never blocks.
  void send(std::span<const std::uint8_t> message, in_addr_t address, std::uint16_t port);

  /// Null: there is no profile.
  const LinkProfile* profile() const { return link_ ? &*link_ : nullptr; }
  /// Number of datagrams dropped before transmission, since the start.
  std::uint64_t dropped() const { return sender().lost(kPriorities - 1); }
  SenderState sender() const;
  /// Queueing time of the oldest datagram.
  Duration waiting() const;
  /// Sends the queued datagrams at the link's rate, for at most a second, and stops.
  void close();

 private:
  struct Packet {
    std::vector<std::uint8_t> bytes{};
    in_addr_t address{};
    std::uint16_t port{};
    int priority{};
  };
  using Waiting = TransmitQueue<Packet>::Waiting;
  struct Class {
    int priority{};
    bool newest_wins{};
    bool keyed{};
  };

  static Duration now();
  void run();
  /// Transmits what is due; returns when to call it next.
  Duration step(Duration at);
  /// The same without a profile: fills the sockets.
  Duration refill(Duration at);
  Waiting classify(std::span<const std::uint8_t> message, in_addr_t address, std::uint16_t port) const;
  bool put_in_socket(std::span<const std::uint8_t> message, in_addr_t address, std::uint16_t port) const;
  Duration airtime(const Packet& packet) const;
  void put_on_air(Packet packet, Duration at, Duration airtime);
  std::uint64_t peer_of(const Packet& packet) const;

  std::optional<LinkProfile> link_;
  Outputs outputs_;
  Socket socket_;
  mutable std::mutex mutex_{};
  std::condition_variable wake_{};
  Random random_;
  TransmitQueue<Packet> queue_{};
  Window window_{};
  std::map<std::uint64_t, LossModel> loss_models_{};
  std::multimap<Duration, Packet> in_air_{};
  std::optional<Waiting> refused_{};  // Refused by a socket; it goes before all others.
  std::map<std::uint32_t, Class> writers_{};
  Duration free_at_{};  // When the channel is free again.
  Duration close_at_{Duration::max()};
  std::thread thread_{};
};

}  // namespace adit::wire
