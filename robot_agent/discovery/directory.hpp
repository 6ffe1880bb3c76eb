#pragma once
#include <string>
#include <vector>

#include "core/topic/topic.hpp"
#include "robot_agent/command/types.hpp"

namespace adit::agent {

/// What an agent answers to "who are you and what can you do?", and whether it is there.
struct AgentRecord {
  std::string name{};
  Id id{};
  bool station{};
  wire::ParticipantId participant{};
  std::uint16_t protocol{};
  std::string software{};
  std::string platform{};    ///< wheeled, tracked, legged; empty for a station
  double length{}, width{};  ///< footprint, m
  double max_speed{};        ///< m/s
  std::vector<std::string> modes{};
  bool present{};
  Time heard{};  ///< our clock; of the last sign of life
};
using AgentList = std::vector<AgentRecord>;  ///< sorted by name

/// Who is there: one published list that every component may follow (DESIGN 6). An agent that comes back as
/// another participant, under whatever address, is the same entry. Bounded.
class Directory {
 public:
  static constexpr std::size_t kCapacity = 128;
  /// Two lost signs of life are forgiven; the list tells within 3 s.
  static constexpr Duration kSilence = 2800ms;

  explicit Directory(Executor& owner) : list_(owner) {}

  void capabilities(const AgentRecord& record, Time now);
  /// A station's sign of life.
  void presence(const std::string& name, const wire::ParticipantId& participant, Time now);
  void participant(const wire::ParticipantEvent& event, Time now);
  /// Stations that fell silent. Ten times a second is often enough.
  void tick(Time now);

  /// Published on every change.
  Topic<AgentList>& list() { return list_; }
  const AgentList& agents() const { return agents_; }

 private:
  AgentRecord* find(const std::string& name);
  void publish() { list_.publish(agents_); }

  AgentList agents_{};
  Topic<AgentList> list_;
};

}  // namespace adit::agent
