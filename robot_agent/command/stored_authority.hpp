// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "robot_agent/command/authority.hpp"
#include "robot_agent/command/types.hpp"
#include "robot_agent/discovery/binding.hpp"

namespace adit::agent {

/// A stored answer, with all that is needed to repeat it.
struct StoredAnswer {
  static constexpr std::size_t kText = 64;

  std::uint64_t seq{};
  Reason reason{Reason::none};
  std::string text{};  ///< At most kText bytes
  bool operator==(const StoredAnswer&) const = default;
};

/// The last answers to one participant, those with the highest numbers.
struct StoredAnswers {
  static constexpr std::size_t kParticipants = 8;  ///< Participants whose answers are stored
  static constexpr std::size_t kAnswers = 8;       ///< Answers stored for each

  wire::ParticipantId participant{};
  std::string station{};
  Id station_id{};
  std::uint64_t newest{};  ///< Highest number received.
  /// Highest number of each line of commands that must stay in order.
  std::array<std::uint64_t, 3> newest_of{};
  std::uint64_t floor{};  ///< Lower numbers that are not among the answers are too old.
  std::vector<StoredAnswer> answers{};
  bool operator==(const StoredAnswers&) const = default;
};

/// The state of the command interface that must survive a restart of the agent.
struct StoredAuthority {
  Epoch epoch{};  ///< The counter continues; the start is drawn again.
  std::optional<Party> holder{};
  std::optional<Binding::Stored> speaker{};  ///< Participant that is bound to the holder's name.
  bool locked{};
  std::vector<Party> stops{};
  bool operator==(const StoredAuthority&) const = default;
};

}  // namespace adit::agent
