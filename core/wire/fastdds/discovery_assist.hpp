// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <netinet/in.h>

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <span>
#include <thread>
#include <vector>

#include "core/time/time.hpp"
#include "core/wire/fastdds/rtps_peek.hpp"
#include "core/wire/qos.hpp"

namespace adit::wire {

/// Retries participant discovery over lossy links. Fast DDS answers a new participant once and requests a
/// missing endpoint once a second; when either message is lost, matching waits for the next announcement.
/// This class inspects all datagrams that pass the sockets, and
/// - repeats our announcement to each peer that was heard and does not show that it heard us;
/// - searches a peer that fell silent: announces us to it until it is heard again;
/// - repeats a discovery heartbeat that is not acknowledged, with a count that the library would not use;
/// - withholds unicast announcements to peers that know us, as they receive the same by multicast. A peer
/// that was silent for Discovery::kLease counts as new when it returns, because the library has dropped it by
/// then. The class holds neither clock nor sockets: the caller passes the time and sends the datagrams. Safe
/// to call from any thread. Peers, repetitions and announcements per second are bounded.
class DiscoveryAssist {
 public:
  using Send =
      std::function<void(std::span<const std::uint8_t> message, in_addr_t address, std::uint16_t port)>;

  /// Sets the addresses (network order) that announcements are repeated to, because an announcement can name
  /// any address. Without this call all are allowed. Call it before the first datagram passes.
  void set_reachable(std::function<bool(in_addr_t address)> reachable) { reachable_ = std::move(reachable); }
  /// Processes a datagram that the library sends to a discovery port, statistics removed. May change
  /// heartbeat counts in it. Returns false when the receiver does not need it.
  bool sent(std::span<std::uint8_t> message, in_addr_t address, std::uint16_t port, Duration now);
  /// Processes a datagram received on any port.
  void received(std::span<const std::uint8_t> message, Duration now);
  /// Forgets a participant that the library dropped: when it returns it counts as new. One that knew us and
  /// did not say goodbye is searched.
  void dropped(const ParticipantId& id, Duration now);
  /// Sends the repetitions that are due. `link_idle`: no other datagram is queued; otherwise heartbeats are
  /// deferred.
  void repeat(Duration now, bool link_idle, const Send& send);
  /// The participant that sends from here; all zero before its first datagram.
  ParticipantId own() const;
  /// Time at which repeat() must be called next; max: not before the next datagram.
  Duration next() const;

 private:
  static constexpr std::size_t kMaxPeers = 256, kMaxSilent = 64;
  /// Largest number of repeated announcements per second, to all peers together; the rest is deferred. Ten
  /// robots and ten stations that start together need 95.
  static constexpr int kMaxAnnouncements = 128;
  struct Beat {
    std::vector<std::uint8_t> message{};
    std::uint64_t last{};
    int repeats{};
    Duration at{};  ///< Time of the next repetition.
  };
  struct Peer {
    in_addr_t address{};
    std::uint16_t port{};
    Duration heard{};  ///< When its last datagram arrived.
    bool knows_us{};
    Duration announced{};  ///< When an announcement was last sent to it by unicast.
    Duration announce_at{Duration::max()};
    int announcements_left{};
    std::map<std::uint32_t, Beat> beats{};  ///< Unacknowledged heartbeats of our discovery writers.
  };
  using Peers = std::map<ParticipantId, Peer>;
  /// A peer that is searched.
  struct Silent {
    in_addr_t address{};
    std::uint16_t port{};
    Duration since{};
  };
  struct Out {
    std::vector<std::uint8_t> message{};
    in_addr_t address{};
    std::uint16_t port{};
  };
  Peer* at(in_addr_t address, std::uint16_t port);
  /// Returns the peer that announced itself at `locator`, created if it is new.
  Peer& meet(const ParticipantId& id, const PeerAddress& locator, Duration now);
  void announce(Duration now, std::vector<Out>& out);
  void search(Duration now, std::vector<Out>& out);
  void repeat_heartbeats(Peer& peer, Duration now, bool link_idle, std::vector<Out>& out);

  std::function<bool(in_addr_t)> reachable_{};
  mutable std::mutex mutex_{};
  ParticipantId own_{};
  std::vector<std::uint8_t> announcement_{};
  Peers peers_{};
  std::map<ParticipantId, Silent> silent_{};  // At most kMaxSilent.
  ParticipantId searched_last_{};             // The next round continues after it.
  Duration search_at_{};
  ParticipantId announced_last_{};  // Last receiver; the next round continues after it.
  Duration second_{};               // Start of the second in which announcements are counted.
  int announced_{};
};

/// The thread that calls DiscoveryAssist::repeat(); it sleeps while nothing is due.
class DiscoveryAssistThread {
 public:
  /// `link_idle` and `send` as in DiscoveryAssist::repeat(), called on the thread.
  DiscoveryAssistThread(DiscoveryAssist& assist, std::function<bool()> link_idle, DiscoveryAssist::Send send);
  ~DiscoveryAssistThread();
  DiscoveryAssistThread(const DiscoveryAssistThread&) = delete;
  DiscoveryAssistThread& operator=(const DiscoveryAssistThread&) = delete;
  /// Wakes the thread after a datagram passed, as something may be due earlier than planned.
  void wake();

 private:
  void run();
  DiscoveryAssist& assist_;
  std::function<bool()> link_idle_;
  DiscoveryAssist::Send send_;
  std::mutex mutex_{};
  std::condition_variable changed_{};
  bool ends_{};
  Duration planned_{Duration::max()};
  std::thread thread_{};
};

}  // namespace adit::wire
