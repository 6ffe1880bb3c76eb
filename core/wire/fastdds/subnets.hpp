// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <netinet/in.h>

#include <string>
#include <vector>

namespace adit::wire {

/// The network mask of an interface with that address, both in network order; all ones when there is none.
in_addr_t network_mask(in_addr_t address);

/// The IPv4 networks of the given interfaces, together with single addresses.
class Subnets {
 public:
  /// `interfaces`: addresses of this machine; one that no interface has counts as a single address. `peers`:
  /// ADDRESS or ADDRESS:PORT.
  Subnets(const std::vector<std::string>& interfaces, const std::vector<std::string>& peers);
  /// `address` is in network order.
  bool contains(in_addr_t address) const;
  /// Whether both addresses, in network order, are in the same one of these networks.
  bool share(in_addr_t a, in_addr_t b) const;

 private:
  struct Network {
    in_addr_t address{}, mask{};
  };
  std::vector<Network> networks_{};
};

}  // namespace adit::wire
