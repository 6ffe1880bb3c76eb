// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core/contract/common.hpp"

namespace adit::radio {
class AuthorityStatus;
}

namespace adit::contract {

/// A station that holds or stops a robot, identified by name and id, independent of its participant.
struct Party {
  std::string name{};
  Id id{};
  bool operator==(const Party&) const = default;
};

/// Which station has authority over a robot, and which stations stopped it.
struct AuthorityStatus {
  static constexpr std::size_t kMaxStops = 16;

  std::string robot{};
  Epoch epoch{};
  std::optional<Party> holder{};
  bool locked{};
  float lease_left{-1.0F};     ///< Time until the lock expires, s; negative: no lease runs.
  std::vector<Party> stops{};  ///< One latch per stopper, at most kMaxStops.
  bool operator==(const AuthorityStatus&) const = default;
};

radio::AuthorityStatus encode(const AuthorityStatus& status);
/// Returns nothing if the robot has no valid name. Names of stations are cleaned.
std::optional<AuthorityStatus> decode(const radio::AuthorityStatus& sample);

}  // namespace adit::contract
