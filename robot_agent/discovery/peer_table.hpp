#pragma once
#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "core/topic/local_topic.hpp"
#include "robot_agent/common/identity.hpp"

namespace adit::agent {

/// Another robot or a station: what it answers to "who are you and what can you do?", and when it was heard.
struct Peer {
  std::string name{};
  Id id{};
  bool station{};
  wire::ParticipantId participant{};  ///< The one that speaks for name and id
  bool described{};                   ///< The capabilities below were heard.
  std::uint16_t protocol{};
  std::string software{};
  std::string platform{};              ///< wheeled, tracked, legged; empty for a station
  double length{}, width{}, height{};  ///< Footprint and height, m
  double max_speed{};                  ///< m/s
  std::vector<std::string> modes{};
  std::optional<Eigen::Vector3d> place{};  ///< Where a station stands, map frame, m; unset: it did not say

  bool namesake{};              ///< Another robot with the name of this one
  bool present{};               ///< Heard within PeerTable::kSilence, and it did not leave
  Time first_heard{}, heard{};  ///< First and last sign of life, by this robot's clock

  Duration age(Time now) const { return now - heard; }
};
using PeerList = std::vector<Peer>;  ///< Sorted by name

/// All that this robot knows of other robots and of stations, with ages by its own clock.
///
/// Discovery fills it: `Directory` decides who speaks for a name and what it can do, the command interface
/// reports the stations it accepts, and other robots with this robot's name are entries of their own. Every
/// other component reads a const PeerTable. Runs on the command strand.
///
/// Bounded: a new peer takes the place of the absent one that was heard longest ago. The holder is never
/// evicted, and when every entry is present it alone still finds room.
class PeerTable {
 public:
  static constexpr std::size_t kCapacity = 128;
  static constexpr std::size_t kNamesakes = 8;  ///< Of the capacity
  /// Two lost signs of life are forgiven; silence shows within 3 s.
  static constexpr Duration kSilence = 2500ms;

  explicit PeerTable(Executor& owner) : list_(owner) {}

  /// Null: no such peer is known. Namesakes are not found by name.
  const Peer* find(const std::string& name) const;
  const Peer* by_participant(const wire::ParticipantId& participant) const;
  /// The station that holds this robot; null while nobody does, or while it was not heard yet.
  const Peer* holder() const;
  const PeerList& all() const { return peers_; }
  /// Published on every change but those of the ages, with this table's entries.
  Subscription follow(Executor& strand, LocalTopic<PeerList>::Handler handler) const {
    return list_.subscribe(strand, std::move(handler));
  }

  // What discovery and the command interface report.

  /// Enters a peer that spoke just now, or replaces the entry of its name. False: there is no room.
  bool put(Peer peer, Time now);
  /// The command interface accepted a sign of life of a station; it may not have described itself yet.
  void accept_station(const Sender& from, Time now);
  /// Another robot with this robot's name spoke.
  void hear_namesake(const std::string& name, const Id& id, const wire::ParticipantId& participant, Time now);
  /// The station that holds this robot; an empty name: nobody does.
  void set_holder(const std::string& name, const Id& id) {
    holder_ = name;
    holder_id_ = id;
  }
  void leave(const wire::ParticipantId& participant);
  /// Marks the silent ones. Ten times a second is often enough.
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
  mutable LocalTopic<PeerList> list_;  // following it changes no peer
};

/// The peers as a table for people: name, kind, age, participant, place.
std::string describe(const PeerTable& peers, Time now);

}  // namespace adit::agent
