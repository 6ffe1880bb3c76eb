#include "core/wire/fastdds/outlet.hpp"

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

namespace adit::wire {

Outlet::Outlet(const std::vector<std::string>& interfaces) {
  for (const std::string& address : interfaces) {
    const int fd = ::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    if (fd < 0) continue;
    in_addr interface {};
    ::inet_pton(AF_INET, address.c_str(), &interface);
    ::setsockopt(fd, IPPROTO_IP, IP_MULTICAST_IF, &interface, sizeof interface);
    sockets_.push_back(fd);
  }
}

Outlet::~Outlet() {
  for (const int fd : sockets_) ::close(fd);
}

void Outlet::send(std::span<const std::uint8_t> message, in_addr_t address, std::uint16_t port) const {
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_addr.s_addr = address;
  to.sin_port = htons(port);
  const bool multicast = IN_MULTICAST(ntohl(address));
  for (const int fd : sockets_) {
    (void)::sendto(fd, message.data(), message.size(), 0, reinterpret_cast<const sockaddr*>(&to), sizeof to);
    if (!multicast) return;
  }
}

}  // namespace adit::wire
