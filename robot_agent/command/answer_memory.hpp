#pragma once
#include <map>
#include <optional>
#include <vector>

#include "core/time/time.hpp"
#include "robot_agent/command/types.hpp"

namespace adit::agent {

/// The last answers per participant, so that a repeated command gets its first answer again and no second
/// effect (rule 1). Bounded.
class AnswerMemory {
 public:
  static constexpr std::uint64_t kAnswers = 64;  ///< per participant
  static constexpr std::size_t kParticipants = 64;

  /// The answer given to that number, null when there is none.
  const Answer* find(const wire::ParticipantId& from, std::uint64_t seq) const;
  /// The number is older than everything remembered, or than a newer command that steers: what moves the
  /// robot must not be overtaken by what was sent before it.
  bool too_old(const wire::ParticipantId& from, std::uint64_t seq, bool steers) const;
  void remember(const wire::ParticipantId& from, const Answer& answer, bool steers, Time now);

 private:
  struct Entry {
    std::vector<Answer> answers{};  ///< slot seq % kAnswers; seq 0: empty
    std::uint64_t newest{};
    std::uint64_t newest_steering{};
    Time used{};
  };
  std::map<wire::ParticipantId, Entry> entries_{};
};

}  // namespace adit::agent
