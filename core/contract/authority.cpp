// SPDX-License-Identifier: Apache-2.0
#include "core/contract/authority.hpp"

#include "adit/authority.h"
#include "core/command/words.hpp"

namespace adit::contract {

radio::AuthorityStatus encode(const AuthorityStatus& status) {
  radio::AuthorityStatus out;
  out.robot(status.robot);
  out.epoch(encode(status.epoch));
  if (status.holder) {
    out.holder(status.holder->name);
    out.holder_id(status.holder->id);
  }
  out.locked(status.locked);
  out.lock_lease_left(status.lease_left);
  for (const Party& stopper : status.stops) {
    if (out.stops().size() == AuthorityStatus::kMaxStops) break;
    radio::Stopper latch;
    latch.station(stopper.name);
    latch.station_id(stopper.id);
    out.stops().push_back(latch);
  }
  return out;
}

std::optional<AuthorityStatus> decode(const radio::AuthorityStatus& sample) {
  if (!command::valid_name(sample.robot())) return std::nullopt;
  AuthorityStatus out{.robot = sample.robot(),
                      .epoch = decode(sample.epoch()),
                      .locked = sample.locked(),
                      .lease_left = finite(sample.lock_lease_left()) ? sample.lock_lease_left() : -1.0F};
  if (!sample.holder().empty()) out.holder = Party{cleaned_name(sample.holder()), sample.holder_id()};
  for (const radio::Stopper& latch : sample.stops()) {
    if (out.stops.size() == AuthorityStatus::kMaxStops) break;
    out.stops.push_back({cleaned_name(latch.station()), latch.station_id()});
  }
  return out;
}

}  // namespace adit::contract
