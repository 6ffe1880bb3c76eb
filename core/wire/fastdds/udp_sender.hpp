#pragma once
#include <netinet/in.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace adit::wire {

/// Sockets of our own, to send from: what is still in the air does not depend on the library's life, and the
/// library writes nothing into what they send. Any thread.
class UdpSender {
 public:
  /// `interfaces`: IPv4 addresses that multicast goes out on.
  explicit UdpSender(const std::vector<std::string>& interfaces);
  ~UdpSender();
  UdpSender(const UdpSender&) = delete;
  UdpSender& operator=(const UdpSender&) = delete;

  /// Sends to an address in network order. Returns false when a socket had no room for the datagram: the
  /// radio sends more slowly than we do, and the caller may try again. A datagram that can never be sent, as
  /// to a network without a route, is lost and counts as sent.
  bool send(std::span<const std::uint8_t> message, in_addr_t address, std::uint16_t port) const;

 private:
  static bool send_by(int socket, std::span<const std::uint8_t> message, const sockaddr_in& to);
  std::vector<int> sockets_{};  // one per interface; the first one for unicast
};

}  // namespace adit::wire
