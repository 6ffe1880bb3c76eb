// SPDX-License-Identifier: Apache-2.0
#include "sim/live/domain_claim.hpp"

#include <sys/socket.h>
#include <sys/un.h>

#include <cerrno>
#include <cstddef>
#include <cstring>

namespace adit::sim {
namespace {

using station::client::File;

/// The process that has the claim; 0 where it cannot be seen from here, as in a container.
pid_t owner(const sockaddr_un& address, socklen_t length) {
  const File peer(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  ucred who{};
  socklen_t size = sizeof who;
  if (::connect(peer.get(), reinterpret_cast<const sockaddr*>(&address), length) != 0) return 0;
  return ::getsockopt(peer.get(), SOL_SOCKET, SO_PEERCRED, &who, &size) == 0 ? who.pid : 0;
}

Error taken(std::uint32_t domain, const std::string& robot, pid_t by) {
  std::string text = "DDS domain " + std::to_string(domain) + ", that of " + robot +
                     ", is served by another simulate already";
  text +=
      by > 0 ? ", process " + std::to_string(by) + ": end it (kill " + std::to_string(by) + ")" : ": end it";
  return {Reason::in_use, text + ", or take other domains with --domain-base"};
}

}  // namespace

Result<DomainClaim> DomainClaim::take(std::uint32_t domain, const std::string& robot) {
  const std::string name = "adit/simulate/" + std::to_string(domain);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::memcpy(address.sun_path + 1, name.data(), name.size());  // A zero first: an abstract name.
  const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
  File socket(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  if (::bind(socket.get(), reinterpret_cast<const sockaddr*>(&address), length) != 0) {
    if (errno == EADDRINUSE) return taken(domain, robot, owner(address, length));
    return {Reason::wire_failed,
            "domain " + std::to_string(domain) + " cannot be claimed: " + std::strerror(errno)};
  }
  // No connection is accepted: another process connects to it only to learn the process id.
  if (::listen(socket.get(), 64) != 0)
    return {Reason::wire_failed,
            "domain " + std::to_string(domain) + " cannot be claimed: " + std::strerror(errno)};
  return DomainClaim(std::move(socket));
}

}  // namespace adit::sim
