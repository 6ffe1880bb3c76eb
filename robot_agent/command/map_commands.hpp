// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <utility>

#include "robot_agent/command/command_interface.hpp"
#include "robot_agent/common/goal_report.hpp"

namespace adit::agent {

/// Commands that need the router's map: has the goal of a `goto` judged before the command interface handles
/// it, and answers `plan` by a route. Other commands pass at once and may overtake them; the command
/// interface compares numbers. Each sample that is received gets an answer (rule 3). Runs on the command
/// strand.
class MapCommands {
 public:
  struct Services {
    /// Both call their function exactly once, or never if the component ends before; see RouterClient.
    std::function<void(const Eigen::Vector3d& goal, bool replace,
                       std::function<void(const Result<GoalReport>&)>)>
        check_goal{};
    std::function<void(const Eigen::Vector3d& goal, std::function<void(const Result<PlannedRoute>&)>)>
        find_route{};
    std::function<Time()> now{};
  };
  using Answered = std::function<void(const std::optional<Answer>&)>;

  MapCommands(CommandInterface& commands, Services services)
      : commands_(commands), services_(std::move(services)) {}

  /// Handles a command; `answered` receives the answer to this sample of it.
  void handle(const Command& command, const Answered& answered);

 private:
  void judge(const Command& asked, const Answered& answered);

  CommandInterface& commands_;
  Services services_;
  /// How many samples of a command, by participant and number, wait for the judgement of its goal.
  std::map<std::pair<wire::ParticipantId, std::uint64_t>, int> judged_{};
};

}  // namespace adit::agent
