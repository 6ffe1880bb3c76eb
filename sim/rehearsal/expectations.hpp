// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <map>

#include "sim/rehearsal/report.hpp"
#include "sim/rehearsal/scenario.hpp"
#include "sim/rehearsal/witness.hpp"
#include "sim/truth/exploration_record.hpp"
#include "sim/truth/map_truth.hpp"

namespace adit::sim {

/// What expectations are judged by, read when they are judged.
struct Evidence {
  std::function<const RobotWord&(const std::string& robot)> word{};
  std::function<Pose2(const std::string& robot)> pose{};  ///< True pose, world frame.
  std::function<int(const std::string& robot)> collisions{};
  std::function<int(const std::string& robot)> caused{};  ///< Contacts caused by the robot.
  const ExplorationRecord* exploration{nullptr};          ///< Of a scenario that explores().
  std::function<std::size_t(const std::string& robot)> index{};
  /// Whether a robot notified an operator of a matter.
  std::function<bool(const std::string& by, const std::string& code, const std::string& robot)> notified{};
  /// Whether a robot gave that reason.
  std::function<bool(const std::string& robot, Reason reason)> reported{};
  /// How right the map of that operator's station is; nothing while it has none.
  std::function<std::optional<MapJudgement>(const std::string& by)> map{};
  std::map<std::string, Reason> last_answer{};      ///< By operator.
  std::map<std::string, std::size_t> findings{};    ///< By operator whose station runs.
  std::map<std::string, std::uint64_t> pictures{};  ///< Live ones, by operator whose station runs.
  std::map<std::string, std::size_t> photos{};      ///< Whole ones, by operator whose station runs.
};

/// Judges a scenario's expectations as time goes on.
class Expectations {
 public:
  explicit Expectations(const Scenario& scenario);

  /// Instants at which something must be judged exactly, ascending.
  std::vector<Duration> instants() const;
  /// To be called at those instants and at 50 Hz, with everything until `now` done.
  void judge(Duration now, const Evidence& evidence);
  /// Whether every expectation that has a time is settled; false when there is none, or when something is
  /// counted until the end of the run.
  bool all_settled() const;
  /// At the end of the run: what never came, and what is counted over the whole of it.
  std::vector<ExpectationResult> finish(const Evidence& evidence, const RunReport& report);

 private:
  /// A robot's pose at the last instant.
  struct PoseSeen {
    Eigen::Vector2d truth{0, 0};
    Duration judged{-1};  ///< When it sent what it had said of it.
  };
  /// Where a robot with a goal was when it last made progress.
  struct Standing {
    Eigen::Vector2d at{0, 0};
    Duration since{};
  };
  struct State {
    bool settled{};
    ExpectationResult result{};
    std::optional<Eigen::Vector2d> start{};    ///< Where the robot was when the time began.
    std::map<std::string, PoseSeen> poses{};   ///< By robot.
    std::map<std::string, Standing> stands{};  ///< By robot.
  };
  std::string watch(const ProgressExpectation& e, Duration now, const Evidence& evidence, State& state) const;

  const Scenario& scenario_;
  std::vector<State> states_;
};

}  // namespace adit::sim
