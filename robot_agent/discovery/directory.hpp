#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core/topic/topic.hpp"
#include "robot_agent/common/identity.hpp"
#include "robot_agent/discovery/binding.hpp"

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

/// Who is there: one published list that every component may follow. An agent that comes back as another
/// participant, under whatever address, is the same entry; a name belongs to its id, and a name and id to the
/// participant that Binding says, so that nobody takes the place of one that is there. Bounded.
class Directory {
 public:
  static constexpr std::size_t kCapacity = 128;
  /// Two lost signs of life are forgiven; the list tells within 3 s.
  static constexpr Duration kSilence = 2500ms;

  explicit Directory(Executor& owner) : list_(owner) {}

  void capabilities(const AgentRecord& record, Time now);
  /// A sign of life of a robot or a station.
  void presence(const std::string& name, const Id& id, const wire::ParticipantId& participant, Time now);
  void participant(const wire::ParticipantEvent& event);
  /// Those that fell silent, and those that may take their places. Ten times a second is often enough.
  void tick(Time now);

  /// Published on every change.
  Topic<AgentList>& list() { return list_; }
  AgentList agents() const;

 private:
  struct Entry {
    AgentRecord record{};
    Binding binding;
    std::optional<AgentRecord> waiting{};  ///< what a newcomer says that may not have the place yet
    std::optional<AgentRecord> former{};   ///< what was there before a newcomer got the place
  };

  Entry* find(const std::string& name);
  bool add(const AgentRecord& record, Time now);
  /// True when the list changed.
  bool hear(Entry& entry, const AgentRecord& record, Time now);
  static bool adopt(Entry& entry, AgentRecord record, Time now);
  void publish() { list_.publish(agents()); }

  std::vector<Entry> entries_{};  ///< sorted by name
  Topic<AgentList> list_;
};

}  // namespace adit::agent
