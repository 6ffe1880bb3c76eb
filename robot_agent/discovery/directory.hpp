// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "robot_agent/common/identity.hpp"
#include "robot_agent/discovery/binding.hpp"
#include "robot_agent/discovery/peer_table.hpp"

namespace adit::agent {

/// Decides which DDS participant is bound to each announced name, and enters its capabilities into the
/// PeerTable.
///
/// A name belongs to one id while a peer with that id is heard. An agent that returns as another participant,
/// under any address, is the same peer. An entry is in one of three states:
///
/// - Settled: only the bound participant announces the name.
/// - Pending: another participant announced the name as well, with the same id or a different one, while the
///   bound participant was heard. Its announcement is stored; tick() processes it again once the bound
///   participant is silent.
/// - Replaced: another participant with the same id was bound. The previous peer is stored, and restored if
///   its participant sends again: the other one was then no restart of the same agent.
///
/// No participant can therefore displace one that is present. The holder's name stays reserved while the
/// holder is silent. The number of entries is that of the PeerTable, which is bounded.
class Directory {
 public:
  /// `peers` must outlive the directory.
  explicit Directory(PeerTable& peers) : peers_(peers) {}

  /// Processes the capabilities that a peer announced.
  void on_capabilities(const Peer& announcement, Time now);
  /// Processes a heartbeat of a robot or a station.
  void on_presence(const std::string& name, const Id& id, const wire::ParticipantId& participant, Time now);
  /// Processes a heartbeat of another robot with this robot's name.
  void on_namesake(const std::string& name, const Id& id, const wire::ParticipantId& participant, Time now) {
    peers_.hear_namesake(name, id, participant, now);
  }
  /// Processes the arrival or the departure of a participant.
  void on_participant(const wire::ParticipantEvent& event);
  /// Marks the peers that fell silent, and binds the participants that may replace them. Call it at 10 Hz.
  void tick(Time now);

 private:
  struct NamedEntry {
    std::string name{};
    Binding binding;
    std::optional<Peer> pending_peer{};   ///< Announced by a participant that is not bound yet.
    std::optional<Peer> previous_peer{};  ///< The peer that was bound before the present one.
  };

  /// The entry of a name; null if the name is not in the table, or no peer announced capabilities with it.
  NamedEntry* find(const std::string& name);
  void add(const Peer& announcement, Time now);
  void on_announcement(NamedEntry& entry, const Peer& announcement, Time now);
  void on_other_id(NamedEntry& entry, const Peer& announcement, Time now);
  /// Enters the announced peer into the table, and stores the one that it replaces.
  void bind(NamedEntry& entry, Peer announcement, Time now);
  static void set_pending(NamedEntry& entry, const Peer& announcement, Time now);

  PeerTable& peers_;
  std::vector<NamedEntry> entries_{};
};

}  // namespace adit::agent
