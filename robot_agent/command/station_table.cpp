// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/command/station_table.hpp"

#include <algorithm>

namespace adit::agent {

StationTable::Verdict StationTable::hear(const MessageSender& from, Sign sign,
                                         const std::optional<Party>& holder, Time now) {
  const bool holds = holder == Party{from.name, from.id};
  const auto found =
      std::find_if(stations_.begin(), stations_.end(), [&](const Station& s) { return s.name == from.name; });
  if (found == stations_.end()) return {add(from, holder, now) ? Reason::none : Reason::unknown_station};
  Station& station = *found;
  if (station.id != from.id) {
    // The holder takes precedence over a station that used its name meanwhile.
    if (!holds && station.binding.alive(now, kHeardFor)) return {Reason::name_in_use};
    station = Station{from.name, from.id, Binding(from.participant, now)};
    return {};
  }
  // A command suffices as a claim for other stations, but a claim to be the holder needs a presence.
  if (holds && !station.holds) station.binding.forget_claim();
  station.holds = holds;
  const auto may_claim = sign == Sign::presence || !holds ? Binding::MayClaim::yes : Binding::MayClaim::no;
  const auto verdict = station.binding.on_heartbeat(from.participant, may_claim, now);
  return {verdict.bound ? Reason::none : Reason::identity_mismatch, verdict.pending, verdict.restarted,
          verdict.rejected};
}

Station* StationTable::add(const MessageSender& from, const std::optional<Party>& holder, Time now) {
  if (stations_.size() >= kCapacity) {
    const auto rank = [&](const Station& s) {
      return std::pair(holder == Party{s.name, s.id}, s.binding.last_seen());
    };
    const auto oldest =
        std::min_element(stations_.begin(), stations_.end(),
                         [&](const Station& a, const Station& b) { return rank(a) < rank(b); });
    if (oldest->binding.alive(now, kHeardFor) && holder != Party{from.name, from.id}) return nullptr;
    stations_.erase(oldest);
  }
  stations_.push_back({from.name, from.id, Binding(from.participant, now)});
  return &stations_.back();
}

void StationTable::restore(const std::string& name, const Id& id, const Binding::Stored& speaker, Time now) {
  Station station{name, id, Binding(speaker, now)};
  station.holds = true;
  stations_.push_back(std::move(station));
}

void StationTable::announce(const std::string& name, std::uint16_t protocol) {
  for (Station& s : stations_)
    if (s.name == name) s.protocol = protocol;
}

void StationTable::leave(const wire::ParticipantId& participant) {
  for (Station& s : stations_) s.binding.on_leave(participant);
}

const Station* StationTable::find(const std::string& name) const {
  for (const Station& s : stations_)
    if (s.name == name) return &s;
  return nullptr;
}

const Station* StationTable::by_participant(const wire::ParticipantId& participant) const {
  for (const Station& s : stations_)
    if (s.binding.participant() == participant) return &s;
  return nullptr;
}

bool StationTable::heard(const std::string& name, Time now) const {
  const Station* station = find(name);
  return station && station->binding.alive(now, kHeardFor);
}

}  // namespace adit::agent
