// SPDX-License-Identifier: Apache-2.0
#include "core/wire/fastdds/udp_sender.hpp"

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>

namespace adit::wire {
namespace {

/// Bytes. The kernel adds its own overhead and doubles the value: it holds some 40 kB of datagrams, 0.3 s at
/// 1 Mbit/s. The others are queued in the LinkShaper, by priority.
constexpr int kSendBuffer = 32768;

void drop_errors(int socket) {
  std::uint8_t control[512];
  for (int i = 0; i < 64; ++i) {
    msghdr message{};
    message.msg_control = control;
    message.msg_controllen = sizeof control;
    if (::recvmsg(socket, &message, MSG_ERRQUEUE | MSG_DONTWAIT) < 0) return;
  }
}

}  // namespace

UdpSender::UdpSender(const std::vector<std::string>& interfaces) {
  for (const std::string& address : interfaces) {
    const int fd = ::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    if (fd < 0) continue;
    in_addr interface {};
    ::inet_pton(AF_INET, address.c_str(), &interface);
    ::setsockopt(fd, IPPROTO_IP, IP_MULTICAST_IF, &interface, sizeof interface);
    ::setsockopt(fd, SOL_SOCKET, SO_SNDBUF, &kSendBuffer, sizeof kSendBuffer);
    // Without this option Linux reports success for a datagram that the interface's queue drops.
    const int on = 1;
    ::setsockopt(fd, IPPROTO_IP, IP_RECVERR, &on, sizeof on);
    sockets_.push_back(fd);
  }
}

UdpSender::~UdpSender() {
  for (const int fd : sockets_) ::close(fd);
}

bool UdpSender::send_by(int socket, std::span<const std::uint8_t> message, const sockaddr_in& to) {
  for (int attempt = 0; attempt < 2; ++attempt) {
    if (::sendto(socket, message.data(), message.size(), 0, reinterpret_cast<const sockaddr*>(&to),
                 sizeof to) >= 0)
      return true;
    if (errno == EAGAIN || errno == EWOULDBLOCK || errno == ENOBUFS || errno == ENOMEM) return false;
    // The error may be that of an earlier datagram, as when no process listens on a peer's port.
    drop_errors(socket);
  }
  return true;
}

bool UdpSender::send(std::span<const std::uint8_t> message, in_addr_t address, std::uint16_t port) const {
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_addr.s_addr = address;
  to.sin_port = htons(port);
  const bool multicast = IN_MULTICAST(ntohl(address));
  bool taken = true;
  for (const int fd : sockets_) {
    taken = send_by(fd, message, to) && taken;
    if (!multicast) break;
  }
  return taken;
}

}  // namespace adit::wire
