// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "robot_agent/common/identity.hpp"
#include "robot_agent/discovery/binding.hpp"
#include "robot_agent/discovery/peer_table.hpp"

namespace adit::agent {

/// Decides which participant is bound to each announced name, and enters it into the PeerTable. An agent that
/// returns as another participant, under any address, is the same peer. A name belongs to its id, and Binding
/// decides which participant has a name and id, so that no participant can displace one that is present. The
/// holder's name stays reserved while the holder is silent. Bounded.
class Directory {
 public:
  /// `peers` must outlive the directory.
  explicit Directory(PeerTable& peers) : peers_(peers) {}

  /// Processes the capabilities that a peer announced.
  void capabilities(const Peer& said, Time now);
  /// Processes a heartbeat of a robot or a station.
  void presence(const std::string& name, const Id& id, const wire::ParticipantId& participant, Time now);
  /// Processes a heartbeat of another robot with this robot's name.
  void namesake(const std::string& name, const Id& id, const wire::ParticipantId& participant, Time now) {
    peers_.hear_namesake(name, id, participant, now);
  }
  void participant(const wire::ParticipantEvent& event);
  /// Updates the peers that fell silent and the participants that may replace them. Call it at 10 Hz.
  void tick(Time now);

 private:
  struct Entry {
    std::string name{};
    Binding binding;
    std::optional<Peer> waiting{};  ///< Capabilities of a new participant that is not bound yet.
    std::optional<Peer> former{};   ///< The entry before a new participant was bound.
  };

  /// The entry of a name; null if the name is not in the table, or no peer announced capabilities with it.
  Entry* find(const std::string& name);
  void add(const Peer& said, Time now);
  void hear(Entry& entry, const Peer& said, Time now);
  void adopt(Entry& entry, Peer said, Time now);
  void wait(Entry& entry, const Peer& said, Time now);

  PeerTable& peers_;
  std::vector<Entry> entries_{};
};

}  // namespace adit::agent
