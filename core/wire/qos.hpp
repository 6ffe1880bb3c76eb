// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <string_view>

#include "core/wire/participant.hpp"

/// QoS of the classes and of discovery. Both adapters use this table, so that a rehearsal is not better than
/// the real wire.
namespace adit::wire {

/// Quality of service of a topic.
struct Qos {
  bool reliable{};         ///< Lost samples are repaired.
  bool transient_local{};  ///< Late joiners receive the history.
  Duration heartbeat{};    ///< Heartbeat period while a sample is not acknowledged.
  int priority{};          ///< Priority on a full link: 0 goes first.
  bool newest_wins{};      ///< A queued sample is replaced by the next one of the same key.
  bool paced{};            ///< A flow controller passes samples on as the link takes them.
};

inline Qos qos_of(QosClass qos) {
  switch (qos) {
    case QosClass::urgent:
      return {true, false, 250ms, 0, false};
    case QosClass::stream:
      return {false, false, 0ms, 2, true};
    case QosClass::state:
      return {false, false, 0ms, 3, true};
    case QosClass::status:
      return {true, true, 500ms, 4, false};
    case QosClass::sensor:
      return {false, false, 0ms, 3, true};
    case QosClass::bulk:
      return {true, false, 1000ms, 5, false, true};
    case QosClass::pieces:  // Neither repaired nor paced by the wire: core/transfer does both.
      return {false, false, 0ms, 5, false};
    case QosClass::video:  // Paced by its sender, which never queues more than one picture.
      return {false, false, 0ms, 6, false};
  }
  return {};
}

/// Whether a topic is one of ROS 2 peers. Default subscriptions there are reliable and match only a reliable
/// writer; sensor publishers are often best effort and match only a best-effort reader. Our writers are
/// therefore reliable and our readers best effort, so that they match all of them; but a reader of a latched
/// topic is reliable, because a best-effort one gets no history. Publishers of these are reliable, as
/// latching needs it. A reader of class bulk is reliable, too: of a large message in many fragments, one that
/// is lost would lose it all.
inline bool is_ros2(const TopicInfo& topic) { return std::string_view(topic.name).starts_with("rt/"); }

inline Qos writer_qos(const TopicInfo& topic) {
  Qos qos = qos_of(topic.qos);
  if (is_ros2(topic)) qos.reliable = true, qos.heartbeat = 250ms;
  return qos;
}
inline Qos reader_qos(const TopicInfo& topic) {
  Qos qos = qos_of(topic.qos);
  if (is_ros2(topic)) qos.reliable = qos.transient_local || topic.qos == QosClass::bulk;
  return qos;
}

/// Largest number of keys of one topic that a writer writes, or that a reader stores at a time: keys of
/// writers that left make room for new ones. With the library's default of 10, every peer beyond the tenth is
/// lost without a report.
inline constexpr std::size_t kMaxKeys = 256;

/// Samples of one sender and key that a reader's mailbox holds until the strand takes them; beyond that, the
/// newest replaces the oldest. Requests and answers get a queue, because a later one does not supersede an
/// earlier one, although their writers repeat only the newest.
inline std::size_t mailbox_depth(const TopicInfo& topic) {
  constexpr std::uint16_t requests = 8;
  const bool request = topic.qos == QosClass::urgent && !is_ros2(topic);
  return std::max<std::uint16_t>(topic.depth, request ? requests : 1);
}
/// True when the handler may run on the thread that received the sample while the strand is idle, which saves
/// waking another thread. Only for velocity commands on their path to the motors: such a handler must not
/// create or destroy endpoints, and its participant receives nothing until it returns.
inline bool handled_in_place(const TopicInfo& topic) {
  return topic.qos == QosClass::stream || (topic.qos == QosClass::urgent && is_ros2(topic));
}
/// Samples that a reader handles in one task; then other tasks of its strand may run.
inline constexpr int kBurstSamples = 16;

/// Discovery parameters, equal for all participants: with leases of different lengths, endpoints are not
/// matched again after a gap longer than one lease and shorter than the other. Any message renews a lease, so
/// announcements can be rare on a slow link.
struct Discovery {
  static constexpr Duration kLease = 60s;            ///< A participant that is silent for longer is dropped.
  static constexpr Duration kAnnouncement = 25s;     ///< Period of participant announcements.
  static constexpr Duration kInitialPeriod = 400ms;  ///< Period of the initial announcements.
  static constexpr int kInitialAnnouncements = 15;   ///< Number of initial announcements: they take 6 s.
  /// Shortest interval at which our announcement is repeated to a peer that was heard and does not show that
  /// it heard us, each time the peer announces itself. Fast DDS alone answers once; when that answer is lost,
  /// the peer waits for our next announcement.
  static constexpr Duration kAnnounceRetryPeriod = 200ms;
  static constexpr int kAnnounceRetries = 12;
  /// A peer that fell silent until its lease ended is sent our announcement once in this time, for kSearch;
  /// of several, one each kSearchStep. Otherwise both wait for the next announcement, 25 s later.
  static constexpr Duration kSearchPeriod = 2s;
  static constexpr Duration kSearchStep = 500ms;
  static constexpr Duration kSearch = 3600s;
  /// Heartbeat period of endpoints that a peer has not acknowledged.
  static constexpr Duration kHeartbeat = 150ms;
};

}  // namespace adit::wire
