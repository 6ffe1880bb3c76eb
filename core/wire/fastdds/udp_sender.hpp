// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <netinet/in.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace adit::wire {

/// Socket for sending that is independent of the library: queued datagrams do not depend on its lifetime, and
/// it writes no statistics into them. All that a participant sends leaves from one port and the addresses
/// that it was given, by which its peers recognise it. Safe to call from any thread.
class UdpSender {
 public:
  /// `interfaces`: the IPv4 addresses to send from.
  explicit UdpSender(const std::vector<std::string>& interfaces);
  ~UdpSender();
  UdpSender(const UdpSender&) = delete;
  UdpSender& operator=(const UdpSender&) = delete;

  /// The port that it sends from; 0 when the system gave none.
  std::uint16_t port() const { return port_; }
  /// Sends to an address in network order. Returns false when the socket had no room for the datagram,
  /// because the radio is slower than the sender; the caller may try again. A datagram that can never be
  /// sent, as to a network without a route, is lost and counts as sent.
  bool send(std::span<const std::uint8_t> message, in_addr_t address, std::uint16_t port) const;

 private:
  struct Interface {
    in_addr address{};
    in_addr_t mask{};
  };
  /// The interface on the network of that address; null: the system chooses.
  const Interface* toward(in_addr_t address) const;
  bool send_from(const Interface* interface, std::span<const std::uint8_t> message, sockaddr_in to) const;

  int socket_{-1};
  std::uint16_t port_{};
  std::vector<Interface> interfaces_{};
};

}  // namespace adit::wire
