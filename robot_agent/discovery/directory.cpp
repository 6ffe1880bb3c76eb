#include "robot_agent/discovery/directory.hpp"

#include <algorithm>
#include <utility>

namespace adit::agent {
namespace {

bool same(const AgentRecord& a, const AgentRecord& b) {
  return a.id == b.id && a.station == b.station && a.participant == b.participant &&
         a.protocol == b.protocol && a.software == b.software && a.platform == b.platform &&
         a.length == b.length && a.width == b.width && a.max_speed == b.max_speed && a.modes == b.modes &&
         a.present == b.present;
}

}  // namespace

Directory::Entry* Directory::find(const std::string& name) {
  for (Entry& entry : entries_)
    if (entry.record.name == name) return &entry;
  return nullptr;
}

AgentList Directory::agents() const {
  AgentList list;
  for (const Entry& entry : entries_) list.push_back(entry.record);
  return list;
}

bool Directory::adopt(Entry& entry, AgentRecord record, Time now) {
  record.present = true;
  record.heard = now;
  const bool changed = !same(entry.record, record);
  if (entry.record.participant != record.participant) entry.former = std::move(entry.record);
  entry.record = std::move(record);
  entry.waiting.reset();
  return changed;
}

bool Directory::add(const AgentRecord& record, Time now) {
  if (entries_.size() >= kCapacity) {
    const auto gone =
        std::find_if(entries_.begin(), entries_.end(), [](const Entry& e) { return !e.record.present; });
    if (gone == entries_.end()) return false;
    entries_.erase(gone);
  }
  const auto place = std::lower_bound(entries_.begin(), entries_.end(), record.name,
                                      [](const Entry& e, const std::string& n) { return e.record.name < n; });
  adopt(*entries_.insert(place, Entry{record, Binding(record.participant, now)}), record, now);
  return true;
}

bool Directory::hear(Entry& entry, const AgentRecord& record, Time now) {
  if (entry.record.id != record.id) {
    if (entry.binding.alive(now, kSilence)) {
      entry.waiting = record;
      entry.waiting->heard = now;
      return false;
    }
    entry.binding = Binding(record.participant, now);
    return adopt(entry, record, now);
  }
  const auto verdict = entry.binding.hear(record.participant, true, now);
  const bool restored = verdict.found_out && entry.record.participant == verdict.found_out && entry.former;
  if (restored) entry.record = *std::exchange(entry.former, std::nullopt);
  if (verdict.found_out && entry.waiting && entry.waiting->participant == verdict.found_out)
    entry.waiting.reset();
  if (verdict.bound) return adopt(entry, record, now) || restored;
  if (verdict.pending) {
    entry.waiting = record;
    entry.waiting->heard = now;
  }
  return false;
}

void Directory::capabilities(const AgentRecord& record, Time now) {
  if (!valid_name(record.name)) return;
  Entry* known = find(record.name);
  if (known ? hear(*known, record, now) : add(record, now)) publish();
}

void Directory::presence(const std::string& name, const Id& id, const wire::ParticipantId& participant,
                         Time now) {
  Entry* known = find(name);
  if (!known) return;  // its capabilities are on their way
  const auto said = [&](const AgentRecord& r) { return r.id == id && r.participant == participant; };
  if (known->waiting && said(*known->waiting)) {
    if (hear(*known, AgentRecord(*known->waiting), now)) publish();
  } else if (known->former && said(*known->former)) {
    if (hear(*known, AgentRecord(*known->former), now)) publish();
  } else if (known->record.id == id) {
    AgentRecord record = known->record;  // what it is now is told by its capabilities
    record.participant = participant;
    if (hear(*known, record, now)) publish();
  }
}

void Directory::participant(const wire::ParticipantEvent& event) {
  if (event.present) return;  // it will speak for itself
  bool changed = false;
  for (Entry& entry : entries_) {
    entry.binding.leave(event.id);
    if (entry.waiting && entry.waiting->participant == event.id) entry.waiting.reset();
    if (entry.record.participant != event.id || !entry.record.present) continue;
    entry.record.present = false;
    changed = true;
  }
  if (changed) publish();
}

void Directory::tick(Time now) {
  bool changed = false;
  for (Entry& entry : entries_) {
    if (entry.waiting && now - entry.waiting->heard < kSilence) {
      const bool same_id = entry.waiting->id == entry.record.id;
      if (!entry.binding.alive(now, same_id ? Binding::kQuiet : kSilence))
        changed = hear(entry, AgentRecord(*entry.waiting), now) || changed;
    }
    if (!entry.record.present || entry.binding.alive(now, kSilence)) continue;
    entry.record.present = false;
    changed = true;
  }
  if (changed) publish();
}

}  // namespace adit::agent
