#pragma once
#include <optional>
#include <string>
#include <vector>

#include "robot_agent/common/identity.hpp"
#include "robot_agent/discovery/binding.hpp"
#include "robot_agent/discovery/peer_table.hpp"

namespace adit::agent {

/// Decides who speaks for each name on the air, and enters it into the PeerTable. An agent that comes back as
/// another participant, under whatever address, is the same peer; a name belongs to its id, and a name and id
/// to the participant that Binding says, so that nobody takes the place of one that is there. The holder's
/// place stays its own while it is silent, too. Bounded.
class Directory {
 public:
  /// `peers` must outlive the directory.
  explicit Directory(PeerTable& peers) : peers_(peers) {}

  /// A peer described itself.
  void capabilities(const Peer& said, Time now);
  /// A sign of life of a robot or a station.
  void presence(const std::string& name, const Id& id, const wire::ParticipantId& participant, Time now);
  /// Another robot with this robot's name gave a sign of life.
  void namesake(const std::string& name, const Id& id, const wire::ParticipantId& participant, Time now) {
    peers_.hear_namesake(name, id, participant, now);
  }
  void participant(const wire::ParticipantEvent& event);
  /// Those that fell silent, and those that may take their places. Ten times a second is often enough.
  void tick(Time now);

 private:
  struct Entry {
    std::string name{};
    Binding binding;
    std::optional<Peer> waiting{};  ///< What a newcomer says that may not have the place yet
    std::optional<Peer> former{};   ///< What was there before a newcomer got the place
  };

  /// Null: the name is not in the table, or nobody described himself by it.
  Entry* find(const std::string& name);
  void add(const Peer& said, Time now);
  void hear(Entry& entry, const Peer& said, Time now);
  void adopt(Entry& entry, Peer said, Time now);
  void wait(Entry& entry, const Peer& said, Time now);

  PeerTable& peers_;
  std::vector<Entry> entries_{};
};

}  // namespace adit::agent
