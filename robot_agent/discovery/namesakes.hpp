// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "core/contract/discovery.hpp"
#include "core/time/time.hpp"
#include "core/wire/participant.hpp"
#include "core/wire/qos.hpp"

namespace adit::agent {

/// Decides which of several robots with one name stays in service, from the messages of the others.
///
/// - A robot that a station had heard for `kSettled` before another one appeared stays; so does one that was
///   held for that long, or before a restart of its agent. No announcement of another robot changes that,
///   because it could be forged.
/// - A newer robot gives way, and announces that with its claim: whether it is held, and its start id. If all
///   the others also give way, e.g. because two robots started together, the one that is held stays,
///   otherwise the one with the lowest start id.
/// - A robot gives way until the others left or were silent for the lease of discovery: one that is out of
///   range for a while still owns the name.
///
/// Pure: the caller has the clock. Bounded.
class Namesakes {
 public:
  static constexpr std::size_t kCapacity = 8;
  static constexpr Duration kSettled = 3s;
  /// Heartbeats that span this time are not late samples of an agent that was restarted.
  static constexpr Duration kConfirm = 1500ms;
  static constexpr Duration kForget = wire::Discovery::kLease;

  enum class Verdict : std::uint8_t {
    alone,      ///< No other robot has the name.
    stays,      ///< Another one has it; this robot stays in service.
    undecided,  ///< Another one was heard first; it is not confirmed yet that it is alive.
    gives_way,
  };
  using Claim = contract::NameClaim;

  explicit Namesakes(const wire::ParticipantId& own) : own_(own) {}

  /// Records a heartbeat of a station.
  void station(Time now);
  /// Sets what this robot claims from now on.
  void claim(const Claim& own, Time now);
  /// Records that this robot was held already before its agent was restarted.
  void held_before();

  /// Processes a heartbeat of another robot with this name.
  void heard(const wire::ParticipantId& from, Time now);
  /// Processes the capabilities of another robot with this name; `claim` is set if it gives way.
  void described(const wire::ParticipantId& from, const std::optional<Claim>& claim, Time now);
  void left(const wire::ParticipantId& participant);
  /// Updates the verdict. Returns a robot of which operators must be notified: one that was confirmed alive,
  /// or any if the verdict changed.
  std::optional<wire::ParticipantId> tick(Time now);

  Verdict verdict() const { return verdict_; }
  /// The claim to announce; unset unless this robot gives way.
  std::optional<Claim> announced() const;
  /// Whether a command is for this robot. `start`: start id in the command's epoch, 0: none.
  bool obeys(std::uint64_t start) const;

 private:
  struct Other {
    wire::ParticipantId participant{};
    Time first{}, last{};
    bool newer{};  ///< It appeared after this robot had settled.
    bool confirmed{};
    std::optional<Claim> claim{};
  };
  Other* find(const wire::ParticipantId& from, Time now);
  Verdict judge() const;
  bool all_give_way() const;

  wire::ParticipantId own_;
  Claim claim_{};
  std::optional<Time> station_since_{}, held_since_{};
  std::vector<Other> others_{};
  Verdict verdict_{Verdict::alone};
};

}  // namespace adit::agent
