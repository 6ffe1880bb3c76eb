// SPDX-License-Identifier: Apache-2.0
#include "core/wire/fastdds/filtering_transport.hpp"

#include <fastrtps/utils/IPLocator.h>
#include <fastdds/rtps/common/LocatorList.hpp>

#include <algorithm>
#include <cstring>

#include "core/wire/cost.hpp"
#include "core/wire/fastdds/link_shaper.hpp"
#include "core/wire/fastdds/ports.hpp"
#include "core/wire/fastdds/rtps_peek.hpp"

namespace adit::wire {
namespace rtps = eprosima::fastrtps::rtps;

ReceiveWatch::Mark::Mark(ReceiveWatch& watch, Duration now) {
  for (auto& slot : watch.since_) {
    Duration::rep free = 0;
    if (!slot.compare_exchange_strong(free, std::max<Duration::rep>(now.count(), 1))) continue;
    slot_ = &slot;
    return;
  }
}

ReceiveWatch::Mark::~Mark() {
  if (slot_ != nullptr) slot_->store(0);
}

Duration ReceiveWatch::longest(Duration now) const {
  Duration longest{};
  for (const auto& slot : since_)
    if (const Duration since{slot.load()}; since != Duration{}) longest = std::max(longest, now - since);
  return longest;
}

void TransportContext::sent(std::span<const std::uint8_t> message, in_addr_t address, std::uint16_t port) {
  const std::uint64_t bytes = message.size() + WireCost::kUdpAndIp;
  total_out.fetch_add(bytes, std::memory_order_relaxed);
  if (is_discovery_port(port)) discovery_out.fetch_add(bytes, std::memory_order_relaxed);
  peers.sent(peek(message), address, port, bytes);
}

void TransportContext::received(std::span<const std::uint8_t> message, std::span<const std::uint8_t> passed,
                                const ParticipantId& own, std::uint32_t port) {
  const RtpsPeek seen = peek(passed);
  if (seen.source == own) return;  // The datagram did not come by radio.
  const std::uint64_t bytes = message.size() + WireCost::kUdpAndIp;
  total_in.fetch_add(bytes, std::memory_order_relaxed);
  if (is_discovery_port(port)) discovery_in.fetch_add(bytes, std::memory_order_relaxed);
  peers.received(seen, bytes);  // A refused one counts for no participant.
}

FilteringTransport::FilteringTransport(const eprosima::fastdds::rtps::ChainingTransportDescriptor& descriptor,
                                       std::shared_ptr<TransportContext> context)
    : ChainingTransport(descriptor),
      descriptor_(const_cast<eprosima::fastdds::rtps::ChainingTransportDescriptor*>(&descriptor)),
      context_(std::move(context)) {}

eprosima::fastdds::rtps::TransportDescriptorInterface* FilteringTransport::get_configuration() {
  return descriptor_;
}

bool FilteringTransport::OpenInputChannel(const rtps::Locator_t& locator,
                                          eprosima::fastdds::rtps::TransportReceiverInterface* receiver,
                                          std::uint32_t largest) {
  // When another process has a port, the library asks for the next one; only a port that opens is ours.
  if (!ChainingTransport::OpenInputChannel(locator, receiver, largest)) return false;
  if (!rtps::IPLocator::isMulticast(locator))
    context_->own_ports.add(rtps::IPLocator::getPhysicalPort(locator));
  return true;
}

bool FilteringTransport::is_unwanted(std::span<const std::uint8_t> message, in_addr_t address,
                                     std::uint16_t port) const {
  if (!context_->is_own(address, port)) return false;
  const auto writer = peek(message).writer;
  return writer && context_->to_others.contains(*writer);
}

void FilteringTransport::send(std::span<const std::uint8_t> message, in_addr_t address, std::uint16_t port) {
  message = message.first(without_statistics(message));
  if (context_->is_own(address, port)) return (void)context_->udp_sender->send(message, address, port);
  const Duration now = std::chrono::steady_clock::now().time_since_epoch();
  if (!context_->guard.may_send(address, port, message.size() + WireCost::kUdpAndIp, now)) return;
  std::vector<std::uint8_t> changed;
  if (is_discovery_port(port)) {
    changed.assign(message.begin(), message.end());
    message = changed;
    if (!context_->assist.sent(changed, address, port, now)) return;
  }
  if (context_->heartbeats.passes(message, address, port, now)) context_->link->send(message, address, port);
  if (context_->repeats) context_->repeats->wake();
}

bool FilteringTransport::send(rtps::SenderResource* low_sender_resource, const rtps::octet* send_buffer,
                              std::uint32_t send_buffer_size,
                              rtps::LocatorsIterator* destination_locators_begin,
                              rtps::LocatorsIterator* destination_locators_end,
                              const std::chrono::steady_clock::time_point& timeout) {
  // The iterators are of several kinds and single-pass, so datagrams are passed down one at a time.
  bool all_sent = true;
  for (auto& destination = *destination_locators_begin; destination != *destination_locators_end;
       ++destination) {
    const rtps::Locator_t& locator = *destination;
    if (!IsLocatorSupported(locator)) continue;
    in_addr_t address{};
    std::memcpy(&address, rtps::IPLocator::getIPv4(locator), sizeof address);
    const std::uint16_t port = rtps::IPLocator::getPhysicalPort(locator);
    if (is_unwanted({send_buffer, send_buffer_size}, address, port)) continue;
    if (context_->link) {
      send({send_buffer, send_buffer_size}, address, port);
      continue;
    }
    context_->sent({send_buffer, send_buffer_size}, address, port);
    rtps::LocatorList_t one;
    one.push_back(locator);
    rtps::Locators begin(one.begin()), end(one.end());
    all_sent &= low_sender_resource->send(send_buffer, send_buffer_size, &begin, &end, timeout);
  }
  return all_sent;
}

void FilteringTransport::receive(eprosima::fastdds::rtps::TransportReceiverInterface* next_receiver,
                                 const rtps::octet* receive_buffer, std::uint32_t receive_buffer_size,
                                 const rtps::Locator_t& local_locator,
                                 const rtps::Locator_t& remote_locator) {
  const std::uint16_t port = rtps::IPLocator::getPhysicalPort(local_locator);
  const Duration now = std::chrono::steady_clock::now().time_since_epoch();
  const ReceiveWatch::Mark mark(context_->receive_watch, now);
  RtpsGuard::Source source{};
  std::memcpy(&source.address, rtps::IPLocator::getIPv4(remote_locator), sizeof source.address);
  source.port = rtps::IPLocator::getPhysicalPort(remote_locator);
  std::vector<std::uint8_t> copy;
  const ParticipantId own = context_->assist.own();
  const auto message = context_->guard.pass({receive_buffer, receive_buffer_size}, source, own, now, copy);
  context_->received({receive_buffer, receive_buffer_size}, message, own, port);
  if (message.empty()) return;
  if (is_discovery_port(port)) {
    context_->assist.received(message, now);
    if (context_->repeats) context_->repeats->wake();
    context_->discovery_gate.wait();
  }
  next_receiver->OnDataReceived(message.data(), static_cast<std::uint32_t>(message.size()), local_locator,
                                remote_locator);
}

}  // namespace adit::wire
