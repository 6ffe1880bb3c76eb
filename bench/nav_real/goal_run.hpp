// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "sim/rehearsal/rehearsal.hpp"

namespace adit::bench {

/// One robot that is sent to one place of a map, in rehearsal.
struct GoalRun {
  std::string map{"geb079.bt"};
  std::string platform{};
  Pose2 start{};
  Eigen::Vector2d goal{0, 0};
  std::string options{};  ///< Of the goto command.
  bool impossible{};      ///< No robot can stand at the goal: no place counts as arrived.
  double limit{};         ///< The run ends so long after the goto, s.
  std::uint64_t seed{1};
};

struct GoalResult {
  std::string error{};   ///< Why the run failed; empty: it did not.
  bool arrived{};        ///< The robot stands at the goal, by its odometry.
  double off{};          ///< Then from the true pose to the goal, m.
  bool ends{};           ///< The robot reported why it does not go on, and stands.
  bool refused{};        ///< The goto command was refused.
  std::string reason{};  ///< Of the refusal, or the code of the first such report.
  double seconds{};      ///< From the goto until the robot arrived, refused or reported, or until the end, s.
  double metres{};       ///< Driven, m.
  double clearance{};    ///< The smallest, m.
  int contacts{};
  std::vector<Pose2> trail{};  ///< True poses, one every 0.1 s.
};

/// The scenario of a run, as a file has it.
std::string scenario_text(const GoalRun& run);
/// Runs it. Ends early, 1 s after the robot stands at its goal, and when it stands 3 s after it refused the
/// goal or reported why it does not go on.
GoalResult drive(const GoalRun& run, std::shared_ptr<const sim::World> world,
                 const sim::AgentFactory& agents);

}  // namespace adit::bench
