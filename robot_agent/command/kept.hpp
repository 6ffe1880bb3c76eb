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

/// An answer that was given: enough to give it again.
struct KeptAnswer {
  static constexpr std::size_t kText = 64;

  std::uint64_t seq{};
  Reason reason{Reason::none};
  std::string text{};  ///< At most kText bytes
  bool operator==(const KeptAnswer&) const = default;
};

/// The last answers to one participant, its highest numbers.
struct KeptAnswers {
  static constexpr std::size_t kParticipants = 8;  ///< Participants whose answers are stored
  static constexpr std::size_t kAnswers = 8;       ///< Answers stored for each

  wire::ParticipantId participant{};
  std::string station{};
  Id station_id{};
  std::uint64_t newest{};                    ///< highest number seen
  std::array<std::uint64_t, 3> newest_of{};  ///< of each line of commands that must not be overtaken
  std::uint64_t floor{};                     ///< lower numbers that are not among the answers are too old
  std::vector<KeptAnswer> answers{};
  bool operator==(const KeptAnswers&) const = default;
};

/// What a restart of the agent must not lose of the command interface.
struct KeptAuthority {
  Epoch epoch{};  ///< the counter goes on; the start is drawn anew
  std::optional<Party> holder{};
  std::optional<Binding::Kept> speaker{};  ///< for the holder
  bool locked{};
  std::vector<Party> stops{};
  bool operator==(const KeptAuthority&) const = default;
};

}  // namespace adit::agent
