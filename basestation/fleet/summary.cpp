// SPDX-License-Identifier: Apache-2.0
#include "basestation/fleet/summary.hpp"

#include <algorithm>

namespace adit::station {

World world_of(const Fleet& fleet, Time now) {
  constexpr std::size_t kMaxNotices = 30;
  World world{.at = seconds(now.time_since_epoch()), .station = fleet.own_name()};
  for (const auto& [name, robot] : fleet.robots()) world.robots.push_back(described(robot, now));
  world.stations.push_back({.name = fleet.own_name(), .self = true, .place = fleet.own_place()});
  for (const auto& [name, station] : fleet.stations()) {
    const Duration age = now - station.last_heard;
    world.stations.push_back({name, false, seconds(age), age > Fleet::kLostAfter, station.place});
  }
  const auto& notices = fleet.notices();
  for (std::size_t i = notices.size() - std::min(notices.size(), kMaxNotices); i < notices.size(); ++i)
    world.notices.push_back(described(notices[i], now));
  for (const auto& [agent, view] : fleet.traffic())
    world.traffic[agent] = {view.total_out, view.total_in, seconds(now - view.last_heard)};
  return world;
}

}  // namespace adit::station
