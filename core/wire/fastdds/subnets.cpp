// SPDX-License-Identifier: Apache-2.0
#include "core/wire/fastdds/subnets.hpp"

#include <arpa/inet.h>
#include <ifaddrs.h>

#include <algorithm>

namespace adit::wire {
namespace {

in_addr_t mask_of(in_addr_t address, const ifaddrs* interfaces) {
  const auto ipv4 = [](const sockaddr* a) {
    return reinterpret_cast<const sockaddr_in*>(a)->sin_addr.s_addr;
  };
  for (const ifaddrs* at = interfaces; at != nullptr; at = at->ifa_next) {
    if (at->ifa_addr == nullptr || at->ifa_netmask == nullptr || at->ifa_addr->sa_family != AF_INET) continue;
    if (ipv4(at->ifa_addr) == address) return ipv4(at->ifa_netmask);
  }
  return INADDR_NONE;
}

}  // namespace

in_addr_t network_mask(in_addr_t address) {
  ifaddrs* own = nullptr;
  if (::getifaddrs(&own) != 0) return INADDR_NONE;
  const in_addr_t mask = mask_of(address, own);
  ::freeifaddrs(own);
  return mask;
}

Subnets::Subnets(const std::vector<std::string>& interfaces, const std::vector<std::string>& peers) {
  ifaddrs* own = nullptr;
  if (::getifaddrs(&own) != 0) own = nullptr;
  for (const std::string& name : interfaces) {
    const in_addr_t address = ::inet_addr(name.c_str());
    networks_.push_back({address, mask_of(address, own)});
  }
  if (own != nullptr) ::freeifaddrs(own);
  for (const std::string& peer : peers)
    networks_.push_back({::inet_addr(peer.substr(0, peer.find(':')).c_str()), INADDR_NONE});
}

bool Subnets::contains(in_addr_t address) const {
  return std::any_of(networks_.begin(), networks_.end(), [address](const Network& network) {
    return (address & network.mask) == (network.address & network.mask);
  });
}

bool Subnets::share(in_addr_t a, in_addr_t b) const {
  return std::any_of(networks_.begin(), networks_.end(), [a, b](const Network& network) {
    return (a & network.mask) == (network.address & network.mask) &&
           (b & network.mask) == (network.address & network.mask);
  });
}

}  // namespace adit::wire
