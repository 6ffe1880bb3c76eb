// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fastdds/rtps/transport/ChainingTransport.h>
#include <fastdds/rtps/transport/ChainingTransportDescriptor.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <set>

#include "core/wire/fastdds/discovery_assist.hpp"
#include "core/wire/fastdds/heartbeat_filter.hpp"
#include "core/wire/fastdds/peer_statistics.hpp"
#include "core/wire/fastdds/rtps_guard.hpp"
#include "core/wire/fastdds/udp_sender.hpp"

namespace adit::wire {

class LinkShaper;

/// Blocks received discovery datagrams until the participant is fully created. Until then Fast DDS 2.9 drops
/// announcements of others: an answer to our first announcement would be lost, and the next one comes only
/// with the peer's announcement period.
class DiscoveryGate {
 public:
  void open() {
    {
      const std::lock_guard lock(mutex_);
      open_ = true;
    }
    opened_.notify_all();
  }
  /// Waits for at most one second, because a participant whose creation fails joins its receiving threads.
  void wait() {
    if (open_.load(std::memory_order_acquire)) return;
    std::unique_lock lock(mutex_);
    opened_.wait_for(lock, std::chrono::seconds(1), [this] { return open_.load(); });
  }

 private:
  std::atomic<bool> open_{false};
  std::mutex mutex_{};
  std::condition_variable opened_{};
};

/// Ports that a participant receives on. They are opened while it is created, and other threads read them
/// meanwhile.
class OwnPorts {
 public:
  void add(std::uint16_t port) {
    const std::size_t at = used_.fetch_add(1);
    if (at < ports_.size()) ports_[at].store(port);
  }
  bool contains(std::uint16_t port) const {
    return std::any_of(ports_.begin(), ports_.end(), [port](const auto& own) { return own.load() == port; });
  }

 private:
  std::array<std::atomic<std::uint16_t>, 8> ports_{};
  std::atomic<std::size_t> used_{};
};

/// Set of entity ids that one thread modifies and others read. When it is full, further ids are ignored.
class EntitySet {
 public:
  void add(std::uint32_t entity) {
    for (auto& slot : entities_)
      if (std::uint32_t empty = 0; slot.compare_exchange_strong(empty, entity)) return;
  }
  void remove(std::uint32_t entity) {
    for (auto& slot : entities_)
      if (std::uint32_t same = entity; slot.compare_exchange_strong(same, 0)) return;
  }
  bool contains(std::uint32_t entity) const {
    return std::any_of(entities_.begin(), entities_.end(),
                       [entity](const auto& slot) { return slot.load(std::memory_order_relaxed) == entity; });
  }

 private:
  std::array<std::atomic<std::uint32_t>, 64> entities_{};
};

/// Since when each receiving thread has been processing its datagram.
class ReceiveWatch {
 public:
  /// Marks one datagram from its constructor to its destructor.
  class Mark {
   public:
    Mark(ReceiveWatch& watch, Duration now);
    ~Mark();
    Mark(const Mark&) = delete;
    Mark& operator=(const Mark&) = delete;

   private:
    std::atomic<Duration::rep>* slot_{};  // Null: more threads receive than there are slots.
  };
  /// How long the datagram that has been in work for longest has been; 0: none is.
  Duration longest(Duration now) const;

 private:
  std::array<std::atomic<Duration::rep>, 16> since_{};  // 0: free.
};

/// State shared by the transports of one participant, including the byte counts of its sockets, UDP and IP
/// headers included.
struct TransportContext {
  std::atomic<std::uint64_t> discovery_out{}, discovery_in{}, total_out{}, total_in{};
  PeerStatistics peers{};          ///< Byte counts by peer.
  DiscoveryGate discovery_gate{};  ///< Received discovery datagrams wait for it.
  /// For a radio: datagrams to other participants leave through it, without parts that are useless there.
  /// Null: the library's own sockets send them unchanged.
  std::shared_ptr<LinkShaper> link{};
  std::set<in_addr_t> own_addresses{};  ///< In network order.
  OwnPorts own_ports{};
  std::shared_ptr<UdpSender> udp_sender{};  ///< For a radio: sends datagrams to this participant itself.
  EntitySet to_others{};  ///< Writers whose samples this participant does not receive itself.
  /// Whether a datagram to that address and port would come back to this participant.
  bool is_own(in_addr_t address, std::uint16_t port) const {
    return own_ports.contains(port) && own_addresses.contains(address);
  }
  HeartbeatFilter heartbeats{Discovery::kHeartbeat};
  DiscoveryAssist assist{};
  RtpsGuard guard{};
  ReceiveWatch receive_watch{};
  std::unique_ptr<DiscoveryAssistThread> repeats{};  ///< For a radio.

  /// Counts a sent datagram.
  void sent(std::span<const std::uint8_t> message, in_addr_t address, std::uint16_t port);
  /// Counts a datagram received on that port. `passed`: what of it is processed; `own`: this participant.
  void received(std::span<const std::uint8_t> message, std::span<const std::uint8_t> passed,
                const ParticipantId& own, std::uint32_t port);
};

/// Transport between the RTPS library and UDP that every datagram passes in both directions. It counts
/// datagrams, removes parts that are useless on a radio, and passes them to the link model if there is one.
/// What arrives passes the guard first.
///
/// The library matches a participant's readers with its own writers; this version cannot disable that. A
/// sample that none of these readers must acknowledge is not sent to ourselves, which saves a system call and
/// waking a thread.
class FilteringTransport final : public eprosima::fastdds::rtps::ChainingTransport {
 public:
  FilteringTransport(const eprosima::fastdds::rtps::ChainingTransportDescriptor& descriptor,
                     std::shared_ptr<TransportContext> context);

  eprosima::fastdds::rtps::TransportDescriptorInterface* get_configuration() override;
  bool OpenInputChannel(const eprosima::fastrtps::rtps::Locator_t& locator,
                        eprosima::fastdds::rtps::TransportReceiverInterface* receiver,
                        std::uint32_t largest) override;
  bool send(eprosima::fastrtps::rtps::SenderResource* low_sender_resource,
            const eprosima::fastrtps::rtps::octet* send_buffer, std::uint32_t send_buffer_size,
            eprosima::fastrtps::rtps::LocatorsIterator* destination_locators_begin,
            eprosima::fastrtps::rtps::LocatorsIterator* destination_locators_end,
            const std::chrono::steady_clock::time_point& timeout) override;
  void receive(eprosima::fastdds::rtps::TransportReceiverInterface* next_receiver,
               const eprosima::fastrtps::rtps::octet* receive_buffer, std::uint32_t receive_buffer_size,
               const eprosima::fastrtps::rtps::Locator_t& local_locator,
               const eprosima::fastrtps::rtps::Locator_t& remote_locator) override;

 private:
  /// Whether a datagram is a sample to ourselves that none of our readers takes.
  bool is_unwanted(std::span<const std::uint8_t> message, in_addr_t address, std::uint16_t port) const;
  /// Sends a datagram for one address by radio, unless it is not needed.
  void send(std::span<const std::uint8_t> message, in_addr_t address, std::uint16_t port);

  // Owned by the creator of the transport.
  eprosima::fastdds::rtps::ChainingTransportDescriptor* descriptor_;
  std::shared_ptr<TransportContext> context_;
};

struct FilteringTransportDescriptor final : eprosima::fastdds::rtps::ChainingTransportDescriptor {
  FilteringTransportDescriptor(std::shared_ptr<eprosima::fastdds::rtps::TransportDescriptorInterface> low,
                               std::shared_ptr<TransportContext> counters)
      : ChainingTransportDescriptor(std::move(low)), context(std::move(counters)) {}
  eprosima::fastdds::rtps::TransportInterface* create_transport() const override {
    return new FilteringTransport(*this, context);
  }
  std::shared_ptr<TransportContext> context;
};

}  // namespace adit::wire
