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
#include "core/wire/fastdds/udp_sender.hpp"

namespace adit::wire {

class LinkShaper;

/// Closed until the participant is whole. Until then Fast DDS 2.9 drops what it hears of others: an answer to
/// its first announcement that came back before would be lost, and the next comes with the other's
/// announcement period.
class DiscoveryGate {
 public:
  void open() {
    {
      const std::lock_guard lock(mutex_);
      open_ = true;
    }
    opened_.notify_all();
  }
  /// At most a second: a participant that cannot be made waits for its receiving threads.
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

/// Ports that a participant hears on; opened while it is made, and asked for meanwhile.
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

/// Entity ids, added and removed by one thread and asked for by others. Beyond its bound it takes no more.
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

/// Bytes that went through a participant's sockets, UDP and IP headers included.
struct TransportContext {
  std::atomic<std::uint64_t> discovery_out{}, discovery_in{}, total_out{}, total_in{};
  PeerStatistics peers{};          ///< the same by peer
  DiscoveryGate discovery_gate{};  ///< discovery datagrams wait here
  /// Of a radio: what is sent to others leaves by it, without what is of no use there. Null: by the library's
  /// own sockets, as it is.
  std::shared_ptr<LinkShaper> link{};
  std::set<in_addr_t> own_addresses{};  ///< network order
  OwnPorts own_ports{};
  std::shared_ptr<UdpSender> udp_sender{};  ///< of a radio: what goes to ourselves
  EntitySet to_others{};                    ///< writers whose samples do not go to ourselves
  /// Whether a datagram to that place would come back to this participant.
  bool is_own(in_addr_t address, std::uint16_t port) const {
    return own_ports.contains(port) && own_addresses.contains(address);
  }
  HeartbeatFilter heartbeats{Discovery::kHeartbeat};
  DiscoveryAssist assist{};
  std::unique_ptr<DiscoveryAssistThread> repeats{};  ///< by radio

  /// Counts a datagram that leaves.
  void sent(std::span<const std::uint8_t> message, in_addr_t address, std::uint16_t port);
  /// One that came in at that port.
  void received(std::span<const std::uint8_t> message, std::uint32_t port);
};

/// Stands between the RTPS library and UDP: every datagram passes here, both ways. It counts them, takes from
/// those that leave by radio what is of no use there, and hands them to the link model where one is named.
///
/// The library matches a participant's readers with its own writers and, in this version, cannot be told not
/// to. A sample that none of them has to acknowledge is not sent to ourselves: it would cost a call of the
/// system and the wake-up of a thread.
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
  /// A sample to ourselves that no reader of ours takes.
  bool is_unwanted(std::span<const std::uint8_t> message, in_addr_t address, std::uint16_t port) const;
  /// Sends by radio what the library sends to one address, as far as it is needed.
  void send(std::span<const std::uint8_t> message, in_addr_t address, std::uint16_t port);

  eprosima::fastdds::rtps::ChainingTransportDescriptor* descriptor_;  // owned by whoever made us
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
