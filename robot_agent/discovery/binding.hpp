// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
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
  /// Time without a heartbeat after which a claimant is bound. Heartbeats are due every second.
  static constexpr Duration kHeartbeatTimeout = 1250ms;
  /// After this silence of the bound participant, any participant with the name and id is bound without an
  /// announcement.
  static constexpr Duration kBindingTimeout = 3s;
  /// Samples that arrive later than this after a participant left do not count as heartbeats.
  static constexpr Duration kGrace = 1s;

  struct Verdict {
    bool bound{};      ///< The participant is bound to the name and id.
    bool pending{};    ///< It claims the binding, and nothing contradicts the claim yet.
    bool restarted{};  ///< It claimed the binding just now, or got it without a claim.
    /// The participant that claimed the binding although the original one still sends: it is no restart.
    std::optional<wire::ParticipantId> rejected{};
  };

  /// The bound participant, the previous one, which may regain the binding, and the one that was rejected.
  /// This state must survive a restart, or the first participant heard afterwards would be bound.
  struct Stored {
    wire::ParticipantId participant{};
    std::optional<wire::ParticipantId> previous{}, rejected{};
    bool operator==(const Stored&) const = default;
  };

  Binding(const wire::ParticipantId& participant, Time now) : participant_(participant), last_seen_(now) {}
  /// Restores a binding, as if its participant had been heard just now.
  Binding(const Stored& stored, Time now)
      : participant_(stored.participant),
        last_seen_(now),
        previous_(stored.previous),
        rebound_at_(now),
        rejected_(stored.rejected) {}

  /// Whether a message of a participant that is not bound counts as a claim to the binding.
  enum class MayClaim : std::uint8_t { no, yes };

  /// Processes a heartbeat of a participant with this name and id.
  Verdict on_heartbeat(const wire::ParticipantId& from, MayClaim may_claim, Time now);
  /// Discards the claim: the claimant must announce itself again.
  void forget_claim() { claimant_.reset(); }
  /// Records that a participant left, or that its lease expired.
  void on_leave(const wire::ParticipantId& participant) { left_ = left_ || participant == participant_; }

  const wire::ParticipantId& participant() const { return participant_; }
  Time last_seen() const { return last_seen_; }
  Stored stored() const { return {participant_, previous_, rejected_}; }
  /// Whether the bound participant did not leave and was heard within the last `timeout`.
  bool alive(Time now, Duration timeout) const { return !left_ && now - last_seen_ < timeout; }
  bool claimed_by(const wire::ParticipantId& participant) const { return claimant_ == participant; }

 private:
  Verdict on_bound_heartbeat(Time now);
  void mark_seen(Time now);
  void rebind(const wire::ParticipantId& to, Time now);

  wire::ParticipantId participant_;
  Time last_seen_;
  bool left_{};
  std::optional<wire::ParticipantId> claimant_{};
  Time claimed_at_{};
  std::optional<wire::ParticipantId> previous_{};  ///< The participant that was bound before.
  Time rebound_at_{};                              ///< Time when the present participant was bound.
  std::optional<wire::ParticipantId> rejected_{};  ///< The last claimant that was no restart.
};

}  // namespace adit::agent
