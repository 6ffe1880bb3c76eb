// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core/component/local_topic.hpp"
#include "robot_agent/common/identity.hpp"
#include "robot_agent/team/beacon.hpp"

namespace adit::agent {

/// Another robot or a station: identity, capabilities and time of the last heartbeat.
struct Peer : contract::Capabilities {
  wire::ParticipantId participant{};  ///< The participant that is bound to name and id.
  bool has_capabilities{};            ///< More than name, id and kind was received.

  std::optional<HeardBeacon> heard_beacon{};  ///< Of a robot; unset: none arrived.

  bool namesake{};                 ///< Another robot with this robot's name.
  bool present{};                  ///< It was heard within PeerTable::kPresenceTimeout, and did not leave.
  Time first_seen{}, last_seen{};  ///< First and last heartbeat, by this robot's clock.

  Duration age(Time now) const { return now - last_seen; }
  bool is_station() const { return kind == contract::AgentKind::station; }
};
using PeerList = std::vector<Peer>;  ///< Sorted by name.

/// The table of the other robots and the stations, with ages by this robot's clock.
///
/// Discovery fills it: `Directory` decides which participant is bound to a name and stores its capabilities,
/// the command interface reports the stations it accepts, and other robots with this robot's name are entries
/// of their own. Every other component reads a const PeerTable. Runs on the command strand.
///
/// Bounded: a new peer replaces the absent one that was heard longest ago. The holder is never evicted, and
/// when every peer is present only the holder is still added.
class PeerTable {
 public:
  static constexpr std::size_t kCapacity = 128;
  static constexpr std::size_t kNamesakes = 8;  ///< Included in the capacity.
  /// Tolerates two lost heartbeats; silence is detected within 3 s.
  static constexpr Duration kPresenceTimeout = 2500ms;

  explicit PeerTable(Executor& owner) : list_(owner) {}

  /// The peer with that name; null if there is none. Namesakes are not found by name.
  const Peer* find(const std::string& name) const;
  const Peer* by_participant(const wire::ParticipantId& participant) const;
  /// Whether that participant is bound to the other robot of that name.
  bool is_robot(const std::string& name, const wire::ParticipantId& participant) const;
  /// The station that holds this robot; null if the robot has no holder, or the station was not heard yet.
  const Peer* holder() const;
  const PeerList& all() const { return peers_; }
  /// Subscribes to this table's entries; they are published on every change except of the ages.
  Subscription follow(Executor& strand, LocalTopic<PeerList>::Handler handler) const {
    return list_.subscribe(strand, std::move(handler));
  }

  // Reports of discovery and the command interface.

  /// Adds a peer that was heard just now, or replaces the entry of its name. Returns false if there is no
  /// room.
  bool put(Peer peer, Time now);
  /// Records a heartbeat of a station that the command interface accepted; the station may not have announced
  /// its capabilities yet.
  void accept_station(const MessageSender& from, Time now);
  /// Records a heartbeat of another robot with this robot's name.
  void hear_namesake(const std::string& name, const Id& id, const wire::ParticipantId& participant, Time now);
  /// Sets the station that holds this robot; an empty name: no holder.
  void set_holder(const std::string& name, const Id& id) {
    holder_ = name;
    holder_id_ = id;
  }
  /// Stores the beacon of a robot that is bound to its name, or counts why it is refused.
  BeaconFault hear_beacon(const TeamBeacon& beacon, const wire::ParticipantId& participant, Time now);
  /// Counts a beacon that could not be read.
  void refuse_beacon(BeaconFault fault) { beacon_faults_.count(fault); }
  const BeaconFaults& beacon_faults() const { return beacon_faults_; }
  /// Whether a robot is present that carries maps.
  bool carrier_present() const;
  /// Number of other robots that are present.
  std::size_t robots_present() const;
  void leave(const wire::ParticipantId& participant);
  /// Marks silent peers as absent. Call it at 10 Hz.
  void tick(Time now);

 private:
  bool is_holder(const Peer& peer) const {
    return !peer.namesake && peer.name == holder_ && peer.id == holder_id_;
  }
  Peer* edit(const std::string& name);
  Peer* add(Peer peer, Time now);
  void touch(Peer& peer, Time now);
  void publish() { list_.publish(peers_); }

  PeerList peers_{};
  std::string holder_{};
  Id holder_id_{};
  BeaconFaults beacon_faults_{};
  mutable LocalTopic<PeerList> list_;  // Mutable: a subscription changes no peer.
};

/// The peers as a readable table: name, kind, age, participant, place.
std::string describe(const PeerTable& peers, Time now);

}  // namespace adit::agent
