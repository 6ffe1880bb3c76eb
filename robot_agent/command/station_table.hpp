#pragma once
#include <optional>
#include <vector>

#include "core/time/time.hpp"
#include "robot_agent/command/types.hpp"

namespace adit::agent {

/// A station counts as heard for this long after its last sign of life.
inline constexpr Duration kHeardFor = 3s;

struct Station {
  std::string name{};
  Id id{};
  wire::ParticipantId participant{};  ///< the one that speaks for it
  Time heard{};
  std::uint16_t protocol{};  ///< 0: not announced yet
  /// The participant that spoke for it before, since when it no longer does, and one that was found out.
  std::optional<wire::ParticipantId> former{};
  Time moved{};
  std::optional<wire::ParticipantId> rival{};
};

/// Which stations are on the air, and which participant speaks for each name (rule 1). Bounded.
///
/// - Same name and id from a new participant: the operator came back, and the binding moves. For the holder
///   a presence is asked first while the bound participant is still heard.
/// - Same name, other id: refused while the first is heard.
/// - The former participant speaks again although another took its place: both live, so the newcomer was
///   no restart. The binding goes back, the newcomer is shut out while the first is heard.
class StationTable {
 public:
  static constexpr std::size_t kCapacity = 64;
  /// Late samples of a participant that ended are no sign of life.
  static constexpr Duration kGrace = 1s;

  enum class Sign { presence, command };
  struct Verdict {
    Reason reason{Reason::none};  ///< name_in_use, identity_mismatch, unknown_station (the table is full)
    bool contested{};             ///< two participants were found to claim the same identity
  };

  /// Judges a sign of life and records it when it is genuine. `holds`: name and id are the holder's.
  Verdict hear(const Sender& from, Sign sign, bool holds, Time now);
  void announce(const std::string& name, std::uint16_t protocol);

  const Station* find(const std::string& name) const;
  const Station* by_participant(const wire::ParticipantId& participant) const;
  bool heard(const std::string& name, Time now) const;
  std::size_t size() const { return stations_.size(); }

 private:
  Verdict rebind(Station& station, const Sender& from, Sign sign, bool holds, Time now);
  Station* add(const Sender& from, Time now);

  std::vector<Station> stations_{};
};

}  // namespace adit::agent
