// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <map>
#include <optional>
#include <vector>

#include "core/time/time.hpp"
#include "robot_agent/command/stored_authority.hpp"
#include "robot_agent/command/types.hpp"

namespace adit::agent {

using command::Line;

/// A bounded memory of the last answers to each participant: a repeated command gets its first answer again
/// and has no second effect (rule 1).
class AnswerMemory {
 public:
  static constexpr std::uint64_t kAnswers = 64;  ///< Per participant.
  static constexpr std::size_t kParticipants = 64;

  /// The answer given to that number; null if there is none.
  const Answer* find(const wire::ParticipantId& from, std::uint64_t seq) const;
  /// Whether the number is older than every stored answer, or than a newer command of its line.
  bool too_old(const wire::ParticipantId& from, std::uint64_t seq, Line line) const;
  /// Stores an answer. `durable`: if the command was accepted, the answer must survive a restart.
  void remember(const wire::ParticipantId& from, const Answer& answer, Line line, bool durable, Time now);

  /// Durable commands accepted since the start of this agent.
  std::uint64_t accepted() const { return accepted_; }

  /// The answers that must survive a restart: the newest ones of the participants heard last.
  std::vector<StoredAnswers> stored() const;
  void restore(const std::vector<StoredAnswers>& stored, Time now);

 private:
  struct ParticipantAnswers {
    std::vector<Answer> answers{};  ///< Index seq % kAnswers; seq 0: empty.
    std::uint64_t newest{};
    std::array<std::uint64_t, 3> newest_of{};  ///< Indexed by Line.
    std::uint64_t floor{};                     ///< Lower numbers may have been answered before a restart.
    Time used{};
  };
  std::map<wire::ParticipantId, ParticipantAnswers> entries_{};
  std::uint64_t accepted_{};
};

}  // namespace adit::agent
