// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <map>
#include <optional>
#include <tuple>
#include <utility>
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
  /// Stores an answer. For a further participant, the answers to one are dropped: to who never gave a command
  /// that was accepted, else to the one heard longest ago, but never to the holder. Any number of strangers
  /// therefore takes no other's.
  /// @param durable  If the command was accepted, the answer must survive a restart.
  /// @param holder   The participant that holds the robot; null: none does.
  void remember(const wire::ParticipantId& from, const Answer& answer, Line line, bool durable, Time now,
                const wire::ParticipantId* holder = nullptr);

  /// Durable commands accepted since the start of this agent.
  std::uint64_t accepted() const { return accepted_; }

  /// The answers that must survive a restart: the newest ones of the participants that would be dropped last.
  std::vector<StoredAnswers> stored(const wire::ParticipantId* holder = nullptr) const;
  void restore(const std::vector<StoredAnswers>& stored, Time now);

 private:
  struct ParticipantAnswers;
  using Entry = std::pair<const wire::ParticipantId, ParticipantAnswers>;
  /// What is least by it is dropped first.
  static std::tuple<bool, bool, Time> worth(const Entry& entry, const wire::ParticipantId* holder);

  struct ParticipantAnswers {
    std::vector<Answer> answers{};  ///< Index seq % kAnswers; seq 0: empty.
    std::uint64_t newest{};
    std::array<std::uint64_t, 3> newest_of{};  ///< Indexed by Line.
    std::uint64_t floor{};                     ///< Lower numbers may have been answered before a restart.
    bool obeyed{};                             ///< One of its commands was accepted.
    Time used{};
  };
  std::map<wire::ParticipantId, ParticipantAnswers> entries_{};
  std::uint64_t accepted_{};
};

}  // namespace adit::agent
