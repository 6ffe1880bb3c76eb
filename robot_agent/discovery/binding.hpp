#pragma once
#include <optional>

#include "core/time/time.hpp"
#include "core/wire/participant.hpp"

namespace adit::agent {

/// Which participant speaks for one name and id. What is announced can be copied by anybody who hears it;
/// that somebody goes on speaking cannot be prevented by a copy. So:
///
/// - A new participant that announces the same name and id claims them. It gets them when the one that speaks
///   for them left, or was quiet for longer than signs of life are apart: a process that was killed and
///   started again is back after 1.25 s at the latest, counted from its death.
/// - When the first speaks again although another claimed, or got, its place, both live, so the newcomer was
/// no
///   restart: the first keeps it, or has it back, and the newcomer is shut out while the first is heard.
///
/// A forger gets a place only for as long as the real one is not heard, as by loss on the radio.
class Binding {
 public:
  /// Signs of life are due every second; one that is later than this is missing.
  static constexpr Duration kQuiet = 1250ms;
  /// Silent for so long, anybody with the name and id may have the place without announcing himself.
  static constexpr Duration kSilent = 3s;
  /// Late samples of a participant that ended are no sign of life.
  static constexpr Duration kGrace = 1s;

  struct Verdict {
    bool bound{};                                    ///< the participant speaks for the name and id
    bool pending{};                                  ///< it claims to, and nothing speaks against it yet
    bool restarted{};                                ///< it claimed just now, or got the place without
    std::optional<wire::ParticipantId> found_out{};  ///< the newcomer that was shown to be no restart
  };

  /// Who has the place, who had it before and may have it back, and who was found out: what a restart must
  /// not forget, or the first to speak after it would have the place.
  struct Kept {
    wire::ParticipantId participant{};
    std::optional<wire::ParticipantId> former{}, rival{};
    bool operator==(const Kept&) const = default;
  };

  Binding(const wire::ParticipantId& participant, Time now) : participant_(participant), heard_(now) {}
  /// As if the participant had spoken just now.
  Binding(const Kept& kept, Time now)
      : participant_(kept.participant), heard_(now), former_(kept.former), moved_(now), rival_(kept.rival) {}

  /// A sign of life. `announces`: it may claim the place; else it counts only for who has it.
  Verdict hear(const wire::ParticipantId& from, bool announces, Time now);
  /// Whoever claims the place has to announce himself anew.
  void forget_claim() { claimant_.reset(); }
  /// The participant left, or its lease ran out.
  void leave(const wire::ParticipantId& participant) { left_ = left_ || participant == participant_; }

  const wire::ParticipantId& participant() const { return participant_; }
  Time heard() const { return heard_; }
  Kept kept() const { return {participant_, former_, rival_}; }
  bool alive(Time now, Duration span) const { return !left_ && now - heard_ < span; }
  bool claimed_by(const wire::ParticipantId& participant) const { return claimant_ == participant; }

 private:
  void speak(Time now);
  void move(const wire::ParticipantId& to, Time now);

  wire::ParticipantId participant_;
  Time heard_;
  bool left_{};
  std::optional<wire::ParticipantId> claimant_{};
  Time claimed_{};
  /// Who had the place before, since when it has not, and one that was found out.
  std::optional<wire::ParticipantId> former_{};
  Time moved_{};
  std::optional<wire::ParticipantId> rival_{};
};

}  // namespace adit::agent
