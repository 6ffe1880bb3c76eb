// SPDX-License-Identifier: Apache-2.0
#include "basestation/host/snapshot.hpp"

#include "basestation/fleet/summary.hpp"

namespace adit::station::host {

World world_of(const Station& station) {
  constexpr std::size_t most_notices = 30;
  const Fleet& fleet = station.fleet();
  const Time now = station.now();
  return {.at = seconds(now.time_since_epoch()),
          .station = station.params().name,
          .link = station.params().link,
          .commands = station.counts(),
          .robots = robots_of(fleet, now),
          .stations = stations_of(fleet, now),
          .notices = notices_of(fleet, most_notices, now),
          .traffic = rates_of(fleet, now)};
}

}  // namespace adit::station::host
