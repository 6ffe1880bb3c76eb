#pragma once
#include <array>
#include <map>
#include <optional>
#include <vector>

#include "core/time/time.hpp"
#include "robot_agent/command/kept.hpp"
#include "robot_agent/command/types.hpp"

namespace adit::agent {

using command::Line;

/// The last answers per participant, so that a repeated command gets its first answer again and no second
/// effect (rule 1). Bounded.
class AnswerMemory {
 public:
  static constexpr std::uint64_t kAnswers = 64;  ///< per participant
  static constexpr std::size_t kParticipants = 64;

  /// The answer given to that number, null when there is none.
  const Answer* find(const wire::ParticipantId& from, std::uint64_t seq) const;
  /// The number is older than everything remembered, or than a newer command of its line.
  bool too_old(const wire::ParticipantId& from, std::uint64_t seq, Line line) const;
  /// `durable`: when it was accepted, a restart must not forget the answer.
  void remember(const wire::ParticipantId& from, const Answer& answer, Line line, bool durable, Time now);

  /// Durable commands accepted since the start of this agent.
  std::uint64_t accepted() const { return accepted_; }

  /// What a restart must not forget: the participants heard last, their newest answers.
  std::vector<KeptAnswers> kept() const;
  void restore(const std::vector<KeptAnswers>& kept, Time now);

 private:
  struct Entry {
    std::vector<Answer> answers{};  ///< slot seq % kAnswers; seq 0: empty
    std::uint64_t newest{};
    std::array<std::uint64_t, 3> newest_of{};  ///< by Line
    std::uint64_t floor{};                     ///< lower numbers may have been answered before a restart
    Time used{};
  };
  std::map<wire::ParticipantId, Entry> entries_{};
  std::uint64_t accepted_{};
};

}  // namespace adit::agent
