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

/// The queue between a participant and its sockets. With a link profile it is the link model: datagrams leave
/// by priority, within their budget, at the link's bandwidth, and arrive late or not at all. Without one
/// datagrams go straight to the sockets; those that a socket has no room for, as when a real radio is full,
/// wait here by priority and are tried again. One thread. It has sockets of its own, so that what is still in
/// the air does not depend on the library's life.
class LinkShaper {
 public:
  /// Functions that it calls from any thread; each may be empty.
  struct Outputs {
    /// A datagram was put on the air.
    std::function<void(std::span<const std::uint8_t> message, in_addr_t address, std::uint16_t port)> sent{};
    /// What lies between us and the peer at that address.
    std::function<Path(in_addr_t address, std::uint16_t port)> path{};
  };
  /// Puts a datagram into a socket; false: the socket has no room now. Never blocks.
  using Socket =
      std::function<bool(std::span<const std::uint8_t> message, in_addr_t address, std::uint16_t port)>;

  /// `seed`: of losses and jitter. `interfaces`: addresses that multicast goes out on.
  LinkShaper(std::optional<LinkProfile> link, std::uint64_t seed, const std::vector<std::string>& interfaces,
             Outputs outputs);
  LinkShaper(std::optional<LinkProfile> link, std::uint64_t seed, Socket socket, Outputs outputs);
  ~LinkShaper();
  LinkShaper(const LinkShaper&) = delete;
  LinkShaper& operator=(const LinkShaper&) = delete;

  /// How a writer's samples are sent: their priority, and whether the newest sample replaces those that wait;
  /// of a keyed topic, those of the same key.
  void add_writer(std::uint32_t entity, int priority, bool newest_wins, bool keyed = false);
  void remove_writer(std::uint32_t entity);

  /// A datagram to an IPv4 address (network order) and port. Never blocks.
  void send(std::span<const std::uint8_t> message, in_addr_t address, std::uint16_t port);

  /// Null: it has none.
  const LinkProfile* profile() const { return link_ ? &*link_ : nullptr; }
  /// Datagrams that were dropped before they went on the air, since the start.
  std::uint64_t dropped() const { return sender().lost(kPriorities - 1); }
  SenderState sender() const;
  /// The longest that anything waits to be sent.
  Duration waiting() const;
  /// Sends what waits, which takes as long as it takes on the link but at most a second, and ends.
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
  /// Puts what is due on the air and into sockets; when to be asked again.
  Duration step(Duration at);
  /// The same without a profile: gives the sockets what they take.
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
  std::optional<Waiting> refused_{};  // by a socket; goes before all others
  std::map<std::uint32_t, Class> writers_{};
  Duration free_at_{};  // the air is ours again
  Duration close_at_{Duration::max()};
  std::thread thread_{};
};

}  // namespace adit::wire
