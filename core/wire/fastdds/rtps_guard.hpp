// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <netinet/in.h>

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <set>
#include <span>
#include <vector>

#include "core/time/time.hpp"
#include "core/wire/link_state.hpp"
#include "core/wire/participant.hpp"

namespace adit::wire {

/// Guard between the network and the library's parser. Fast DDS 2.9 trusts what it parses: one submessage of
/// a vendor ends the process, one jump of a sequence number keeps a receiving thread busy for years, a
/// fragment names the size of the memory that is taken for its sample, and anybody can say that somebody else
/// has left.
///
/// On every domain the guard passes submessages of known kinds, with lengths that fit, with numbers close to
/// the ones before, and with fragments of samples within the largest bound of its topics. On a radio domain
/// it also knows the participants: each one announces itself from one socket, and only what comes from that
/// socket is believed to be from it. Discovery data is believed from the participant that it is about.
/// Addresses that an announcement names besides its own are removed, its lease is set to Discovery::kLease,
/// and participants, endpoints and the bytes that are sent to a participant that has never answered are
/// bounded.
///
/// A participant on the radio must therefore send from one port, as UdpSender does. One that moves to another
/// socket with the same id is believed after it was silent for kSilence, or after its goodbye; its first
/// socket may come back at any time.
///
/// The class holds neither clock nor sockets. Safe to call from any thread.
class RtpsGuard {
 public:
  /// The first number that is heard of a writer, on a radio: 77 days at 10 Hz. The library counts up to it.
  static constexpr std::uint64_t kMaxFirst = 1 << 26;
  static constexpr std::uint64_t kMaxFirstElsewhere = 1 << 30;  ///< 12 days at 1 kHz.
  /// Afterwards, numbers that a writer may be ahead of this rate since then.
  static constexpr std::uint64_t kMaxJump = 1 << 16, kNumbersPerSecond = 10'000;
  /// Numbers that a writer may declare irrelevant at once, and per second: the library stores each one. A
  /// history holds up to 2048 samples.
  static constexpr std::uint64_t kMaxGap = 1 << 12, kGapPerSecond = 100;
  static constexpr std::size_t kMaxParticipants = 256;
  static constexpr std::size_t kMaxPerAddress = 128;
  /// Participants of one address that have not answered us yet; ten robots and ten stations on one machine
  /// that start together need 20.
  static constexpr std::size_t kMaxUnanswered = 32;
  static constexpr std::size_t kMaxEndpoints = 256;  ///< Of one participant; a station of 64 robots has 143.
  static constexpr Duration kSilence = 3s;
  /// Bytes to a participant that has not answered: its announcements and endpoints need 20 kB.
  static constexpr std::uint64_t kFirstBytes = 48 << 10;
  static constexpr std::uint64_t kBytesPerSecond = 2 << 10;  ///< And afterwards.

  struct Source {
    in_addr_t address{};  ///< In network order.
    std::uint16_t port{};
    auto operator<=>(const Source&) const = default;
  };
  struct Settings {
    bool radio{};  ///< Whether participants are bound to their sockets.
    /// Whether an address (network order) is on one of our networks; unset: all are.
    std::function<bool(in_addr_t address)> reachable{};
    /// Whether two addresses are on the same one of our networks; unset: never.
    std::function<bool(in_addr_t a, in_addr_t b)> neighbours{};
    /// Whether a source is our own socket.
    std::function<bool(Source)> own{};
  };

  /// Call it before the first datagram passes.
  void set(Settings settings) { settings_ = std::move(settings); }
  /// Admits samples of that size, bytes with the encapsulation: that of a topic of this participant. A sample
  /// up to the largest of all is left to its reader, which counts what is too large for its topic: refused
  /// here, a reliable one would be repaired for ever.
  void admit_samples(std::uint32_t max_bytes);

  /// Returns the part of a received message that the library may parse; nothing when it may not.
  /// @param own   the receiving participant; all zero while it is not known.
  /// @param copy  holds the result where it is no part of `message`.
  std::span<const std::uint8_t> pass(std::span<const std::uint8_t> message, Source source,
                                     const ParticipantId& own, Duration now, std::vector<std::uint8_t>& copy);
  /// Whether a datagram of that many bytes, headers included, may be sent to an address: not when it would be
  /// more than its share to a participant that never showed that it is there.
  bool may_send(in_addr_t address, std::uint16_t port, std::uint64_t bytes, Duration now);

  /// Number of datagrams that were refused since the start, by Refusal.
  RefusalCounts refused() const;

 private:
  /// What a writer was seen to number. The library starts from 0.
  struct Numbers {
    struct Start {
      std::uint64_t number{};  ///< 0: none was heard.
      Duration at{};
      /// The largest number that is possible by now.
      std::uint64_t most(Duration now) const {
        return number + kMaxJump +
               kNumbersPerSecond * static_cast<std::uint64_t>((now - at) / std::chrono::seconds(1));
      }
    };
    Start samples{}, beats{};  ///< Of its first sample, and of the first number of its first heartbeat.
    std::uint64_t gaps{};  ///< Numbers that it declared irrelevant, at `gaps_at`, less those forgiven since.
    Duration gaps_at{};
    /// Size of the sample and of its fragments by number, of those with fragments: they must not change.
    std::map<std::uint64_t, std::pair<std::uint32_t, std::uint16_t>> fragmented{};
    std::uint64_t fragmented_before{};  ///< Up to this number they are forgotten.
  };
  struct Peer {
    std::uint16_t port{};                        ///< The port that it sends from.
    std::vector<in_addr_t> addresses{};          ///< Its addresses.
    std::vector<Source> locators{};              ///< Where it receives.
    Source first{};                              ///< The socket of its first announcement.
    Duration met{}, heard{};                     ///< When its first and last datagram were believed.
    bool answered{};                             ///< It has addressed us.
    std::uint64_t sent{};                        ///< Bytes to it while it has not answered.
    std::map<std::uint32_t, Numbers> numbers{};  ///< By writer.
    std::set<std::uint32_t> endpoints{};         ///< That were announced.
  };
  using Peers = std::map<ParticipantId, Peer>;
  class Reading;  // The state while one message is read.

  /// Lifts the bound of what is sent to it.
  void drop_locators(const Peer& peer);
  void forget(Peers::iterator peer);
  void forget_silent(Duration now);

  Settings settings_{};
  mutable std::mutex mutex_{};
  Peers peers_{};
  std::map<Source, ParticipantId> unanswered_{};  ///< By locator, the peers that have not answered.
  std::uint32_t largest_{64 << 10};               ///< Of a sample, bytes; less is no danger.
  RefusalCounts refused_{};
};

}  // namespace adit::wire
