#pragma once
#include <algorithm>
#include <string_view>

#include "core/wire/participant.hpp"

/// What the QoS classes and discovery get: one table for both adapters, so that a rehearsal does not flatter.
namespace adit::wire {

struct Qos {
  bool reliable{};         ///< repaired after loss
  bool transient_local{};  ///< the history is sent to late joiners
  Duration heartbeat{};    ///< between heartbeats while something is not acknowledged
  int priority{};          ///< on a link that is full: 0 goes first
  bool newest_wins{};      ///< what waits to be sent is replaced by the next sample of the same key
  bool paced{};            ///< handed on as the link takes it, by a flow controller
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
    case QosClass::video:
      return {false, false, 0ms, 6, true};
  }
  return {};
}

/// Topics of ROS 2 peers. Default subscriptions there are reliable and match a reliable writer only; sensor
/// publishers are often best effort and match a best-effort reader only. So our writers are reliable and our
/// readers best effort: they match everybody.
inline bool is_ros2(const TopicInfo& topic) { return std::string_view(topic.name).starts_with("rt/"); }

inline Qos writer_qos(const TopicInfo& topic) {
  Qos qos = qos_of(topic.qos);
  if (is_ros2(topic)) qos.reliable = true, qos.heartbeat = 250ms;
  return qos;
}
inline Qos reader_qos(const TopicInfo& topic) {
  Qos qos = qos_of(topic.qos);
  if (is_ros2(topic)) qos.reliable = false;
  return qos;
}

/// Keys of one topic that a writer writes, and that a reader stores at a time: those of writers that left
/// give way to new ones. The library's default of 10 loses every peer beyond the tenth in silence.
inline constexpr std::size_t kMaxKeys = 256;

/// Samples of one sender and key that wait for a reader's strand; then the newest replaces the oldest. A
/// request or an answer is not made void by the one after it, although its writer repeats the newest alone.
inline std::size_t mailbox_depth(const TopicInfo& topic) {
  constexpr std::uint16_t requests = 8;
  const bool request = topic.qos == QosClass::urgent && !is_ros2(topic);
  return std::max<std::uint16_t>(topic.depth, request ? requests : 1);
}
/// True: when the strand is idle, the handler runs on the thread that received the sample, which saves the
/// wake-up of another one. For a velocity on its way to the wheels only: such a handler must not make or drop
/// endpoints, and while it does not return, its participant receives nothing.
inline bool handled_in_place(const TopicInfo& topic) {
  return topic.qos == QosClass::stream || (topic.qos == QosClass::urgent && is_ros2(topic));
}
/// Samples that a reader handles in one go; then other tasks of its strand have their turn.
inline constexpr int kBurstSamples = 16;

/// Discovery, equal everywhere: with leases of different lengths endpoints are not matched again after a
/// gap between the two. Any message renews a lease, so announcements can be rare on a thin link.
struct Discovery {
  static constexpr Duration kLease = 60s;            ///< a silent participant is dropped after it
  static constexpr Duration kAnnouncement = 25s;     ///< period of participant announcements
  static constexpr Duration kInitialPeriod = 400ms;  ///< period of the first ones
  static constexpr int kInitialAnnouncements = 15;   ///< their number: 6 s of them
  /// Whoever was heard and does not show that it heard us is told of us again, each time that it announces
  /// itself so often. Fast DDS alone answers once: that lost, the other hears of us with our next
  /// announcement.
  static constexpr Duration kAnnounceRetryPeriod = 200ms;
  static constexpr int kAnnounceRetries = 12;
  static constexpr Duration kHeartbeat = 150ms;  ///< of endpoints that a peer has not acknowledged
};

}  // namespace adit::wire
