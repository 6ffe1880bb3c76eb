// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <netinet/in.h>

#include <string>
#include <vector>

namespace adit::wire {

/// The IPv4 networks of the given interfaces, together with single addresses.
class Subnets {
 public:
  /// `interfaces`: addresses of this machine; one that no interface has counts as a single address. `peers`:
  /// ADDRESS or ADDRESS:PORT.
  Subnets(const std::vector<std::string>& interfaces, const std::vector<std::string>& peers);
  /// `address` is in network order.
  bool contains(in_addr_t address) const;

 private:
  struct Network {
    in_addr_t address{}, mask{};
  };
  std::vector<Network> networks_{};
};

}  // namespace adit::wire
