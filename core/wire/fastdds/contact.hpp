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

/// How two participants that meet over a bad link come to know each other. Fast DDS answers a newcomer once
/// and asks for a missing endpoint once a second: where that is lost, the other does not know us until our
/// next announcement. Here, by what passes the sockets:
/// - whoever was heard and does not show that it heard us is told of us again and again;
/// - a discovery heartbeat that is not acknowledged is said again, with a count that the library would not
/// use;
/// - whoever knows us is not told once more by unicast what goes out by multicast anyway.
/// Pure: clock and sockets are the caller's. Any thread. Bounded in peers and in repetitions.
class Contact {
 public:
  using Send =
      std::function<void(std::span<const std::uint8_t> message, in_addr_t address, std::uint16_t port)>;

  /// A datagram that the library sends to a discovery port, without statistics. False: it is not needed. May
  /// change heartbeat counts in it.
  bool sent(std::span<std::uint8_t> message, in_addr_t address, std::uint16_t port, Duration now);
  /// One that came in on any port.
  void received(std::span<const std::uint8_t> message, Duration now);
  /// Sends what is due. `calm`: nothing else waits to be sent; else heartbeats wait.
  void repeat(Duration now, bool calm, const Send& send);
  /// Whether that participant is the one that sends here.
  bool is_own(const ParticipantId& id) const;
  /// When to call repeat() next; max: not before something passes.
  Duration next() const;

 private:
  static constexpr std::size_t most_peers = 256;
  struct Beat {
    std::vector<std::uint8_t> message{};
    std::uint64_t last{};
    int repeats{};
    Duration at{};  ///< of the next repetition
  };
  struct Peer {
    in_addr_t address{};
    std::uint16_t port{};
    bool knows_us{};
    Duration told{};  ///< when an announcement was last sent to it alone
    Duration tell_at{Duration::max()};
    int tells{};                            ///< that are left
    std::map<std::uint32_t, Beat> beats{};  ///< of our discovery writers, not acknowledged
  };
  Peer* at(in_addr_t address, std::uint16_t port);

  mutable std::mutex mutex_{};
  ParticipantId own_{};
  std::vector<std::uint8_t> announcement_{};
  std::map<ParticipantId, Peer> peers_{};
};

/// The thread that repeats; it sleeps while there is nothing to repeat.
class ContactThread {
 public:
  /// `calm` and `send` as above, called on the thread.
  ContactThread(Contact& contact, std::function<bool()> calm, Contact::Send send);
  ~ContactThread();
  ContactThread(const ContactThread&) = delete;
  ContactThread& operator=(const ContactThread&) = delete;
  /// Something passed: there may be something to repeat.
  void wake();

 private:
  void run();
  Contact& contact_;
  std::function<bool()> calm_;
  Contact::Send send_;
  std::mutex mutex_{};
  std::condition_variable changed_{};
  bool ends_{};
  Duration planned_{Duration::max()};
  std::thread thread_{};
};

}  // namespace adit::wire
