// SPDX-License-Identifier: Apache-2.0
#include "core/wire/fastdds/udp_sender.hpp"

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "core/wire/fastdds/subnets.hpp"

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
    in_addr interface {};
    if (::inet_pton(AF_INET, address.c_str(), &interface) == 1)
      interfaces_.push_back({interface, network_mask(interface.s_addr)});
  }
  socket_ = ::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (socket_ < 0) return;
  ::setsockopt(socket_, SOL_SOCKET, SO_SNDBUF, &kSendBuffer, sizeof kSendBuffer);
  // Without this option Linux reports success for a datagram that the interface's queue drops.
  const int on = 1;
  ::setsockopt(socket_, IPPROTO_IP, IP_RECVERR, &on, sizeof on);
  sockaddr_in own{};
  own.sin_family = AF_INET;
  socklen_t size = sizeof own;
  if (::bind(socket_, reinterpret_cast<const sockaddr*>(&own), sizeof own) == 0 &&
      ::getsockname(socket_, reinterpret_cast<sockaddr*>(&own), &size) == 0)
    port_ = ntohs(own.sin_port);
}

UdpSender::~UdpSender() {
  if (socket_ >= 0) ::close(socket_);
}

const UdpSender::Interface* UdpSender::toward(in_addr_t address) const {
  // An interface can have several addresses, of which the system takes the first.
  if (interfaces_.size() == 1) return &interfaces_.front();
  const auto found = std::find_if(interfaces_.begin(), interfaces_.end(), [address](const Interface& own) {
    return (own.address.s_addr & own.mask) == (address & own.mask);
  });
  return found == interfaces_.end() ? nullptr : &*found;
}

bool UdpSender::send_from(const Interface* interface, std::span<const std::uint8_t> message,
                          sockaddr_in to) const {
  iovec part{const_cast<std::uint8_t*>(message.data()), message.size()};
  msghdr header{};
  header.msg_name = &to;
  header.msg_namelen = sizeof to;
  header.msg_iov = &part;
  header.msg_iovlen = 1;
  alignas(cmsghdr) std::uint8_t control[CMSG_SPACE(sizeof(in_pktinfo))]{};
  if (interface != nullptr) {
    header.msg_control = control;
    header.msg_controllen = sizeof control;
    cmsghdr* const first = CMSG_FIRSTHDR(&header);
    first->cmsg_level = IPPROTO_IP;
    first->cmsg_type = IP_PKTINFO;
    first->cmsg_len = CMSG_LEN(sizeof(in_pktinfo));
    in_pktinfo info{};
    info.ipi_spec_dst =
        interface->address;  // A multicast datagram leaves by the interface of its source address.
    std::memcpy(CMSG_DATA(first), &info, sizeof info);
  }
  for (int attempt = 0; attempt < 2; ++attempt) {
    if (::sendmsg(socket_, &header, 0) >= 0) return true;
    if (errno == EAGAIN || errno == EWOULDBLOCK || errno == ENOBUFS || errno == ENOMEM) return false;
    // The error may be that of an earlier datagram, as when no process listens on a peer's port.
    drop_errors(socket_);
  }
  return true;
}

bool UdpSender::send(std::span<const std::uint8_t> message, in_addr_t address, std::uint16_t port) const {
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_addr.s_addr = address;
  to.sin_port = htons(port);
  if (!IN_MULTICAST(ntohl(address))) return send_from(toward(address), message, to);
  bool taken = true;
  for (const Interface& interface : interfaces_)
    // Once on each network, and from the address that unicast comes from.
    if (toward(interface.address.s_addr) == &interface) taken = send_from(&interface, message, to) && taken;
  return taken;
}

}  // namespace adit::wire
