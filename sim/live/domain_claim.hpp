// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>

#include "basestation/client/file.hpp"
#include "core/result/result.hpp"

namespace adit::sim {

/// The sole right of this process to simulate the robot of a DDS domain.
///
/// Two simulators on one domain would both send a robot's odometry, so that it jumps between two worlds. The
/// claim is a socket with an abstract name: it is seen by all users of this network namespace, as the domain
/// is, and the kernel drops it however the process ends.
class DomainClaim {
 public:
  /// Claims that domain for `robot`. Errors: in_use, with the process that has it; wire_failed.
  static Result<DomainClaim> take(std::uint32_t domain, const std::string& robot);

 private:
  explicit DomainClaim(station::client::File socket) : socket_(std::move(socket)) {}

  station::client::File socket_;
};

}  // namespace adit::sim
