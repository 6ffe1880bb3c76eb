// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fastdds/rtps/common/Guid.h>

#include <array>
#include <map>
#include <mutex>

#include "core/wire/participant.hpp"

namespace adit::wire {

/// The writers and readers of all other participants, with their topics and types, as they announce them.
/// Bounded; endpoints beyond the bound are not listed. Safe to call from any thread.
class RemoteEndpoints {
 public:
  void found(const eprosima::fastrtps::rtps::GUID_t& guid, std::string topic, std::string type, bool writes);
  void lost(const eprosima::fastrtps::rtps::GUID_t& guid);
  void lost_all(const ParticipantId& participant);
  std::vector<RemoteEndpoint> of(const std::string& topic) const;

 private:
  static constexpr std::size_t kMost = 4096;
  using Key = std::array<std::uint8_t, 16>;  // Participant, then entity.
  struct Entry {
    std::string topic{};
    RemoteEndpoint endpoint{};
  };
  static Key key_of(const eprosima::fastrtps::rtps::GUID_t& guid);

  mutable std::mutex mutex_{};
  std::map<Key, Entry> entries_{};
};

}  // namespace adit::wire
