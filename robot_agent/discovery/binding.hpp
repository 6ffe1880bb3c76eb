// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "core/time/time.hpp"
#include "core/wire/participant.hpp"

namespace adit::agent {

/// Binds a name and id to one DDS participant.
///
/// An announcement can be copied by any participant that receives it, but a copy cannot stop the original
/// from sending. Therefore:
///
/// - A new participant that announces the same name and id claims them. It gets them if the bound participant
///   left, or was silent for longer than the heartbeat period: a process that was killed and restarted is
///   bound again 1.25 s after its death at the latest.
/// - If the bound participant sends again although another one claimed or got its binding, both are alive, so
///   the new participant is no restart: the original keeps or regains the binding, and the new one is
///   rejected while the original is heard.
///
/// A forger is therefore bound only while the original is not heard, e.g. because of radio loss.
class Binding {
 public:
  /// Heartbeats are due every second; one that is later than this counts as missing.
  static constexpr Duration kQuiet = 1250ms;
  /// After this silence of the bound participant, any participant with the name and id is bound without an
  /// announcement.
  static constexpr Duration kSilent = 3s;
  /// Samples that arrive later than this after a participant left do not count as heartbeats.
  static constexpr Duration kGrace = 1s;

  struct Verdict {
    bool bound{};      ///< The participant is bound to the name and id.
    bool pending{};    ///< It claims the binding, and nothing contradicts the claim yet.
    bool restarted{};  ///< It claimed the binding just now, or got it without a claim.
    /// The new participant that turned out to be no restart.
    std::optional<wire::ParticipantId> found_out{};
  };

  /// The bound participant, the previous one, which may regain the binding, and the one that was rejected.
  /// This state must survive a restart, or the first participant heard afterwards would be bound.
  struct Kept {
    wire::ParticipantId participant{};
    std::optional<wire::ParticipantId> former{}, rival{};
    bool operator==(const Kept&) const = default;
  };

  Binding(const wire::ParticipantId& participant, Time now) : participant_(participant), heard_(now) {}
  /// Restores a binding, as if its participant had been heard just now.
  Binding(const Kept& kept, Time now)
      : participant_(kept.participant), heard_(now), former_(kept.former), moved_(now), rival_(kept.rival) {}

  /// Processes a heartbeat. `announces`: it may claim the binding; otherwise it counts only for the bound
  /// participant.
  Verdict hear(const wire::ParticipantId& from, bool announces, Time now);
  /// Discards the claim: the claimant must announce itself again.
  void forget_claim() { claimant_.reset(); }
  /// Records that a participant left, or that its lease expired.
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
  /// The participant that was bound before, the time of the change, and a rejected participant.
  std::optional<wire::ParticipantId> former_{};
  Time moved_{};
  std::optional<wire::ParticipantId> rival_{};
};

}  // namespace adit::agent
