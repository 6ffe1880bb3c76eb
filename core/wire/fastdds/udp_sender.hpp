// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <netinet/in.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace adit::wire {

/// Sockets for sending that are independent of the library: queued datagrams do not depend on its lifetime,
/// and it writes no statistics into them. Safe to call from any thread.
class UdpSender {
 public:
  /// `interfaces`: IPv4 addresses on which multicast is sent.
  explicit UdpSender(const std::vector<std::string>& interfaces);
  ~UdpSender();
  UdpSender(const UdpSender&) = delete;
  UdpSender& operator=(const UdpSender&) = delete;

  /// Sends to an address in network order. Returns false when a socket had no room for the datagram, because
  /// the radio is slower than the sender; the caller may try again. A datagram that can never be sent, as to
  /// a network without a route, is lost and counts as sent.
  bool send(std::span<const std::uint8_t> message, in_addr_t address, std::uint16_t port) const;

 private:
  static bool send_by(int socket, std::span<const std::uint8_t> message, const sockaddr_in& to);
  std::vector<int> sockets_{};  // One per interface; the first one is also for unicast.
};

}  // namespace adit::wire
