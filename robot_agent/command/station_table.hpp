// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <vector>

#include "core/time/time.hpp"
#include "robot_agent/command/authority.hpp"
#include "robot_agent/command/types.hpp"
#include "robot_agent/discovery/binding.hpp"

namespace adit::agent {

/// A station counts as heard for this long after its last heartbeat.
inline constexpr Duration kHeardFor = Binding::kBindingTimeout;

/// A station in radio contact.
struct Station {
  std::string name{};
  Id id{};
  Binding binding;           ///< The participant that sends for this station.
  std::uint16_t protocol{};  ///< 0: not announced yet.
  bool holds{};              ///< It held the robot when it was heard last.
};

/// The table of stations in radio contact, and of the participant bound to each name (rule 1). Bounded; the
/// holder is never evicted, and only the holder is added to a table full of stations that are heard.
///
/// - Same name and id from a new participant: the station was restarted, as Binding judges. The holder must
///   send a presence for this; for other stations a command suffices.
/// - Same name, other id: refused while the first station is heard.
class StationTable {
 public:
  static constexpr std::size_t kCapacity = 64;

  enum class Sign { presence, command };
  struct Verdict {
    Reason reason{
        Reason::none};  ///< `name_in_use`, `identity_mismatch` or `unknown_station` (the table is full).
    bool pending{};     ///< With `identity_mismatch`: it may be the station after a restart.
    bool restarted{};   ///< A new participant sends for the station, or claims to.
    std::optional<wire::ParticipantId> rejected{};  ///< A participant that claimed another one's identity.
  };

  /// Judges a heartbeat and records it if it is genuine. `holder`: the robot's holder.
  Verdict hear(const MessageSender& from, Sign sign, const std::optional<Party>& holder, Time now);
  /// Restores the holder's name, id and bound participant after a restart, before any message is processed.
  void restore(const std::string& name, const Id& id, const Binding::Stored& speaker, Time now);
  void announce(const std::string& name, std::uint16_t protocol);
  /// Records that a participant left, or that its lease expired.
  void leave(const wire::ParticipantId& participant);

  const Station* find(const std::string& name) const;
  const Station* by_participant(const wire::ParticipantId& participant) const;
  bool heard(const std::string& name, Time now) const;
  std::size_t size() const { return stations_.size(); }

 private:
  Station* add(const MessageSender& from, const std::optional<Party>& holder, Time now);

  std::vector<Station> stations_{};
};

}  // namespace adit::agent
