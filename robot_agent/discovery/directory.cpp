#include "robot_agent/discovery/directory.hpp"

#include <algorithm>

namespace adit::agent {
namespace {

bool same(const AgentRecord& a, const AgentRecord& b) {
  return a.id == b.id && a.station == b.station && a.participant == b.participant &&
         a.protocol == b.protocol && a.software == b.software && a.platform == b.platform &&
         a.length == b.length && a.width == b.width && a.max_speed == b.max_speed && a.modes == b.modes &&
         a.present == b.present;
}

}  // namespace

AgentRecord* Directory::find(const std::string& name) {
  for (AgentRecord& agent : agents_)
    if (agent.name == name) return &agent;
  return nullptr;
}

void Directory::capabilities(const AgentRecord& record, Time now) {
  if (!valid_name(record.name)) return;
  AgentRecord next = record;
  next.present = true;
  next.heard = now;
  if (AgentRecord* known = find(record.name)) {
    const bool changed = !same(*known, next);
    *known = std::move(next);
    if (changed) publish();
    return;
  }
  if (agents_.size() >= kCapacity) {
    const auto gone = std::find_if(agents_.begin(), agents_.end(), [](const auto& a) { return !a.present; });
    if (gone == agents_.end()) return;
    agents_.erase(gone);
  }
  const auto place = std::lower_bound(agents_.begin(), agents_.end(), next.name,
                                      [](const AgentRecord& a, const std::string& n) { return a.name < n; });
  agents_.insert(place, std::move(next));
  publish();
}

void Directory::presence(const std::string& name, const wire::ParticipantId& participant, Time now) {
  AgentRecord* known = find(name);
  if (!known || !known->station) return;  // its capabilities are on their way
  known->heard = now;
  if (known->present && known->participant == participant) return;
  known->present = true;
  known->participant = participant;
  publish();
}

void Directory::participant(const wire::ParticipantEvent& event, Time now) {
  for (AgentRecord& agent : agents_) {
    if (agent.participant != event.id || agent.present == event.present) continue;
    agent.present = event.present;
    agent.heard = now;
    publish();
  }
}

void Directory::tick(Time now) {
  for (AgentRecord& agent : agents_) {
    if (!agent.station || !agent.present || now - agent.heard < kSilence) continue;
    agent.present = false;
    publish();
  }
}

}  // namespace adit::agent
