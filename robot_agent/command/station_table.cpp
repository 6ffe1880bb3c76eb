#include "robot_agent/command/station_table.hpp"

#include <algorithm>

namespace adit::agent {

bool valid_name(const std::string& name) {
  const auto good = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  };
  return !name.empty() && name.size() <= 32 && std::all_of(name.begin(), name.end(), good);
}

StationTable::Verdict StationTable::hear(const Sender& from, Sign sign, bool holds, Time now) {
  const auto found =
      std::find_if(stations_.begin(), stations_.end(), [&](const Station& s) { return s.name == from.name; });
  if (found == stations_.end()) return {add(from, now) ? Reason::none : Reason::unknown_station};
  Station& station = *found;
  if (station.id != from.id) {
    // The holder has the better right to his name than whoever used it while he was away.
    if (!holds && now - station.heard < kHeardFor) return {Reason::name_in_use};
    station = Station{from.name, from.id, from.participant, now, 0, {}, {}, {}};
    return {};
  }
  if (station.participant != from.participant) return rebind(station, from, sign, holds, now);
  station.heard = now;
  return {};
}

StationTable::Verdict StationTable::rebind(Station& station, const Sender& from, Sign sign, bool holds,
                                           Time now) {
  const bool first_heard = now - station.heard < kHeardFor;
  if (first_heard && station.rival == from.participant) return {Reason::identity_mismatch};
  if (first_heard && station.former == from.participant) {
    if (now - station.moved < kGrace) return {Reason::identity_mismatch};
    station.rival = station.participant;
    station.former.reset();
    station.participant = from.participant;
    station.heard = now;
    return {Reason::none, true};
  }
  if (holds && first_heard && sign == Sign::command) return {Reason::identity_mismatch};
  station.former = station.participant;
  station.moved = now;
  station.participant = from.participant;
  station.heard = now;
  return {};
}

Station* StationTable::add(const Sender& from, Time now) {
  if (stations_.size() >= kCapacity) {
    const auto oldest =
        std::min_element(stations_.begin(), stations_.end(),
                         [](const Station& a, const Station& b) { return a.heard < b.heard; });
    if (now - oldest->heard < kHeardFor) return nullptr;
    stations_.erase(oldest);
  }
  stations_.push_back({from.name, from.id, from.participant, now, 0, {}, {}, {}});
  return &stations_.back();
}

void StationTable::announce(const std::string& name, std::uint16_t protocol) {
  for (Station& s : stations_)
    if (s.name == name) s.protocol = protocol;
}

const Station* StationTable::find(const std::string& name) const {
  for (const Station& s : stations_)
    if (s.name == name) return &s;
  return nullptr;
}

const Station* StationTable::by_participant(const wire::ParticipantId& participant) const {
  for (const Station& s : stations_)
    if (s.participant == participant) return &s;
  return nullptr;
}

bool StationTable::heard(const std::string& name, Time now) const {
  const Station* station = find(name);
  return station && now - station->heard < kHeardFor;
}

}  // namespace adit::agent
