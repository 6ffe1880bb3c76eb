// SPDX-License-Identifier: Apache-2.0
#include "basestation/fleet/summary.hpp"

namespace adit::station {

std::vector<Robot> robots_of(const Fleet& fleet, Time now) {
  std::vector<Robot> robots;
  for (const auto& [name, robot] : fleet.robots()) robots.push_back(described(robot, now));
  return robots;
}

std::vector<StationSummary> stations_of(const Fleet& fleet, Time now) {
  std::vector<StationSummary> stations{{.name = fleet.own_name(), .self = true, .place = fleet.own_place()}};
  for (const auto& [name, station] : fleet.stations()) {
    const Duration age = now - station.last_heard;
    stations.push_back({name, false, seconds(age), age > Fleet::kLostAfter, station.place});
  }
  return stations;
}

std::vector<Notice> notices_of(const Fleet& fleet, std::size_t most, Time now) {
  std::vector<Notice> notices;
  const auto& all = fleet.notices();
  for (std::size_t i = all.size() > most ? all.size() - most : 0; i < all.size(); ++i)
    notices.push_back(described(all[i], now));
  return notices;
}

std::map<std::string, AgentRate> rates_of(const Fleet& fleet, Time now) {
  std::map<std::string, AgentRate> rates;
  for (const auto& [agent, view] : fleet.traffic())
    rates[agent] = {view.total_out, view.total_in, seconds(now - view.last_heard)};
  return rates;
}

}  // namespace adit::station
