// SPDX-License-Identifier: Apache-2.0
#include "core/wire/fastdds/remote_endpoints.hpp"

#include <algorithm>

namespace adit::wire {
namespace rtps = eprosima::fastrtps::rtps;

RemoteEndpoints::Key RemoteEndpoints::key_of(const rtps::GUID_t& guid) {
  Key key{};
  std::copy(std::begin(guid.guidPrefix.value), std::end(guid.guidPrefix.value), key.begin());
  std::copy(std::begin(guid.entityId.value), std::end(guid.entityId.value), key.begin() + 12);
  return key;
}

void RemoteEndpoints::found(const rtps::GUID_t& guid, std::string topic, std::string type, bool writes) {
  const Key key = key_of(guid);
  const std::lock_guard lock(mutex_);
  if (entries_.size() >= kMost && !entries_.contains(key)) return;
  Entry& entry = entries_[key];
  entry.topic = std::move(topic);
  std::copy_n(key.begin(), entry.endpoint.participant.size(), entry.endpoint.participant.begin());
  entry.endpoint.type = std::move(type);
  entry.endpoint.writes = writes;
}

void RemoteEndpoints::lost(const rtps::GUID_t& guid) {
  const std::lock_guard lock(mutex_);
  entries_.erase(key_of(guid));
}

void RemoteEndpoints::lost_all(const ParticipantId& participant) {
  const std::lock_guard lock(mutex_);
  std::erase_if(entries_,
                [&](const auto& entry) { return entry.second.endpoint.participant == participant; });
}

std::vector<RemoteEndpoint> RemoteEndpoints::of(const std::string& topic) const {
  const std::lock_guard lock(mutex_);
  std::vector<RemoteEndpoint> result;
  for (const auto& [key, entry] : entries_)
    if (entry.topic == topic) result.push_back(entry.endpoint);
  return result;
}

}  // namespace adit::wire
