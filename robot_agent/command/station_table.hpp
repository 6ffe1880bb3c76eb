#pragma once
#include <optional>
#include <vector>

#include "core/time/time.hpp"
#include "robot_agent/command/authority.hpp"
#include "robot_agent/command/types.hpp"
#include "robot_agent/discovery/binding.hpp"

namespace adit::agent {

/// A station counts as heard for this long after its last sign of life.
inline constexpr Duration kHeardFor = Binding::kSilent;

struct Station {
  std::string name{};
  Id id{};
  Binding binding;           ///< the participant that speaks for it
  std::uint16_t protocol{};  ///< 0: not announced yet
  bool holds{};              ///< the robot, when it was heard last
};

/// Which stations are on the air, and which participant speaks for each name (rule 1). Bounded; the holder is
/// never evicted, and it alone finds room in a table full of stations that are heard.
///
/// - Same name and id from a new participant: the operator came back, as Binding judges. Of the holder a
///   presence is asked; of others a command tells as much.
/// - Same name, other id: refused while the first is heard.
class StationTable {
 public:
  static constexpr std::size_t kCapacity = 64;

  enum class Sign { presence, command };
  struct Verdict {
    Reason reason{Reason::none};  ///< name_in_use, identity_mismatch, unknown_station (the table is full)
    bool pending{};               ///< identity_mismatch, but it may be the operator come back
    bool restarted{};             ///< a new participant speaks for the station, or claims to
    std::optional<wire::ParticipantId> found_out{};  ///< one that claimed an identity that is another's
  };

  /// Judges a sign of life and records it when it is genuine. `holder`: of the robot.
  Verdict hear(const Sender& from, Sign sign, const std::optional<Party>& holder, Time now);
  /// After a restart, before anything was heard: `name` and `id` are the holder's, and this is who speaks for
  /// them.
  void restore(const std::string& name, const Id& id, const Binding::Kept& speaker, Time now);
  void announce(const std::string& name, std::uint16_t protocol);
  /// A participant left, or its lease ran out.
  void leave(const wire::ParticipantId& participant);

  const Station* find(const std::string& name) const;
  const Station* by_participant(const wire::ParticipantId& participant) const;
  bool heard(const std::string& name, Time now) const;
  /// The ids of all that are heard.
  std::vector<Id> heard_ids(Time now) const;
  std::size_t size() const { return stations_.size(); }

 private:
  Station* add(const Sender& from, const std::optional<Party>& holder, Time now);

  std::vector<Station> stations_{};
};

}  // namespace adit::agent
