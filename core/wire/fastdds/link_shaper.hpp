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

#include "core/wire/link/model.hpp"
#include "core/wire/link/transmit_queue.hpp"
#include "core/wire/link_state.hpp"

namespace adit::wire {

/// The transmit queue between a participant and its sockets. With a link profile it is the link model:
/// datagrams leave by priority, within their budget, at the link's bandwidth, and arrive late or are lost.
/// Without one, datagrams go straight to the socket; those that it has no room for, as when a real radio is
/// full, are queued by priority and retried. It runs one thread, so that it can still send queued datagrams
/// while Fast DDS destroys the participant. All times are those of
/// std::chrono::steady_clock, since its epoch.
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

  /// @param link        The link model's profile; unset: datagrams go straight to the socket.
  /// @param seed        Seed of the random losses and the jitter.
  /// @param socket      Sends what leaves the queue.
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

  /// The link model's profile; null if there is none.
  const LinkProfile* profile() const { return link_ ? &*link_ : nullptr; }
  /// Number of datagrams of all priorities that were dropped before transmission, since the start.
  std::uint64_t dropped() const {
    constexpr std::size_t last_priority = kPriorities - 1;
    return sender().lost(last_priority);
  }
  /// The state of the queue, by priority.
  SenderState sender() const;
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
  /// How the samples of a writer are sent; see add_writer().
  struct WriterSettings {
    int priority{};
    bool newest_wins{};
    bool keyed{};
  };

  static Duration now();
  void run();
  /// With a profile: transmits the datagrams that are due at time `at`. Returns the time of the next call.
  Duration step(Duration at);
  /// Without a profile: sends queued datagrams until a socket is full. Returns the time of the next call.
  Duration refill(Duration at);
  /// Looks up the priority of a datagram, and the queued datagram that it replaces, if any.
  Waiting classify(std::span<const std::uint8_t> message, in_addr_t address, std::uint16_t port) const;
  /// Returns false if the socket has no room.
  bool put_in_socket(std::span<const std::uint8_t> message, in_addr_t address, std::uint16_t port) const;
  /// Time that the datagram occupies the channel.
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
  std::multimap<Duration, Packet> in_air_{};  ///< Transmitted datagrams by the time of their arrival.
  std::optional<Waiting> refused_{};  ///< The datagram that a socket refused; it is sent before all others.
  std::map<std::uint32_t, WriterSettings> writers_{};  ///< By entity id.
  Duration free_at_{};                                 ///< Time when the channel is free again.
  Duration close_at_{Duration::max()};  ///< Time when the thread ends even if datagrams are queued.
  std::thread thread_{};
};

}  // namespace adit::wire
