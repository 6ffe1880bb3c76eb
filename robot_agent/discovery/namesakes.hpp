#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "core/time/time.hpp"
#include "core/wire/participant.hpp"
#include "core/wire/qos.hpp"

namespace adit::agent {

/// Judges which of several robots with one name stays in service, from what this robot hears of the others.
///
/// - A robot that a station had heard for `kSettled` before another one appeared stays; so does one that was
/// held
///   so long, or before a restart of its agent. Nothing that others announce changes that: it could be
///   forged.
/// - A robot that is newer gives way, and announces that with its claim: whether it is held, and its start
/// id. When
///   all the others give way as well, as when two start together, the one that is held stays, then the lower
///   start id.
/// - It gives way until the others left or were silent for the lease of discovery: one that is out of range
/// for a
///   while still owns the name.
///
/// Pure: the caller has the clock. Bounded.
class Namesakes {
 public:
  static constexpr std::size_t kCapacity = 8;
  static constexpr Duration kSettled = 3s;
  /// Signs of life over such a span are no late samples of an agent that was restarted.
  static constexpr Duration kConfirm = 1500ms;
  static constexpr Duration kForget = wire::Discovery::kLease;

  enum class Verdict : std::uint8_t {
    alone,      ///< No other robot has the name.
    stays,      ///< Another one has it; this robot stays in service.
    undecided,  ///< Another one was heard first; whether it lives is not sure yet.
    gives_way,
  };
  /// What a robot that gives way announces.
  struct Claim {
    bool held{};
    std::uint64_t start{};  ///< id of the start of its command component, as in its epoch
    bool operator==(const Claim&) const = default;
  };

  explicit Namesakes(const wire::ParticipantId& own) : own_(own) {}

  /// A station was heard.
  void station(Time now);
  /// What this robot claims from now on.
  void claim(const Claim& own, Time now);
  /// This robot was held already before its agent was restarted.
  void held_before();

  /// Another robot with this name gave a sign of life.
  void heard(const wire::ParticipantId& from, Time now);
  /// It described itself; `claim`: it gives way.
  void described(const wire::ParticipantId& from, const std::optional<Claim>& claim, Time now);
  void left(const wire::ParticipantId& participant);
  /// Returns a robot that operators are to hear of: one that turned out to live, or any when the verdict
  /// changed.
  std::optional<wire::ParticipantId> tick(Time now);

  Verdict verdict() const { return verdict_; }
  /// What to announce; nothing unless this robot gives way.
  std::optional<Claim> announced() const;
  /// Whether a command is for this robot. `start`: id of the start in its epoch, 0: none.
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
