#pragma once
#include <netinet/in.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace adit::wire {

/// Sockets of our own, to send from: what is still in the air does not depend on the library's life, and the
/// library writes nothing into what they send. Any thread.
class Outlet {
 public:
  /// `interfaces`: IPv4 addresses that multicast goes out on.
  explicit Outlet(const std::vector<std::string>& interfaces);
  ~Outlet();
  Outlet(const Outlet&) = delete;
  Outlet& operator=(const Outlet&) = delete;

  /// To an address in network order. What the socket does not take at once is lost, as on the air.
  void send(std::span<const std::uint8_t> message, in_addr_t address, std::uint16_t port) const;

 private:
  std::vector<int> sockets_{};  // one per interface; the first one for unicast
};

}  // namespace adit::wire
