// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <functional>
#include <optional>

#include "core/contract/robot.hpp"
#include "nav/explore/explorer.hpp"
#include "robot_agent/behaviour/facts.hpp"
#include "robot_agent/command/types.hpp"
#include "robot_agent/common/exploration.hpp"
#include "robot_agent/motion/mux.hpp"
#include "robot_agent/state/snapshot.hpp"

namespace adit::agent {

class Convoy;
class RightOfWay;

using contract::kFarthestPlace;

using contract::GoalState;

/// A mode's goal and the robot's progress towards it, and what else the mode reports.
struct ModeProgress {
  GoalState state{GoalState::none};
  std::uint32_t goal_id{};
  Eigen::Vector3d goal{Eigen::Vector3d::Zero()};  ///< Map frame, m.
  Reason reason{Reason::none};                    ///< Why it is blocked.
  bool finished{};                                ///< Nothing is left to do: the robot changes to hold.
  Progress navigation{};                          ///< Navigation's progress, of `get_out`.
  contract::Exploration exploration{};            ///< Of a mode that explores.
};

/// The context passed to a mode's module on construction.
struct ModeContext {
  Mux::Output output{};  ///< To the mux: passes while the mode is admitted and the tree runs it.
  NotifyHolder notify_holder{};
  /// Whether no known obstacle covers a place (map frame, m).
  std::function<bool(const Eigen::Vector2d&)> goal_free{};
  /// Height of a goal without z, m; empty: the goal is on the floor.
  std::function<double()> height{};
  /// Pose of the robot (map frame); unset while localisation is not initialised.
  std::function<std::optional<Pose2>()> pose{};
  /// Metres that the robot needs to stop.
  std::function<double()> stopping{};
  Convoy* convoy{};            ///< The robot's place in a convoy; null: it has no team.
  RightOfWay* right_of_way{};  ///< Null: it makes way for no robot.
  /// Asks the router for the next goal of an exploration and calls `done` once, or never if the robot's
  /// frames changed meanwhile; the goal is in the map frame. Error outside_area: the area of the query does
  /// not exist any more. Empty: the robot has no explorer.
  std::function<void(const NextPlaceQuery&, std::function<void(const Result<nav::ExploreStep>&)> done)>
      explore{};
  /// Whether the robot has a holder that was heard within the last 3 s. Empty: never.
  std::function<bool()> holder_heard{};
  std::optional<Eigen::Vector2d> home{};  ///< Where the robot started, map frame, m.
};

/// One mode of the mode table: turns its input into motions for the mux.
///
/// A module decides neither whether its mode may be entered nor whether its output passes: table, guard and
/// tree do. It runs on the command strand. A module overrides only the calls that its mode needs.
class ModeModule {
 public:
  ModeModule() = default;
  virtual ~ModeModule() = default;
  ModeModule(const ModeModule&) = delete;
  ModeModule& operator=(const ModeModule&) = delete;

  /// Adds the module's facts to the inputs of the conditions. Called in every mode.
  virtual void note(Facts&, Time) const {}

  /// Called when the mode was requested and admitted, also if the mode was already active.
  virtual void enter(Time) {}
  /// Called when the mode ended: another one was requested, or the robot fell to hold. A goal stays stored.
  virtual void leave(Time) {}
  /// Forgets the goal: the row says `cleared`, and another mode was requested.
  virtual void clear() {}
  /// At 20 Hz and after every change while the mode lasts. `passes`: the output is enabled, and the mode not
  /// paused.
  virtual void tick(bool passes, Time now) = 0;

  /// Receives a velocity, body frame: a fresh sample of the holder's stick (`Accepts::stick`), or, in every
  /// mode, one of the program that steers (`Accepts::program`).
  virtual void steer(const Twist2&, Time) {}
  /// Checks a goal (`Accepts::goal`; map frame, m; z is NaN if not given), and sets the facts as they would
  /// be with this goal. Errors: out_of_range.
  virtual Result<void> check_goal(const Eigen::Vector3d&, Facts&) const {
    return {Reason::not_supported, "goto: the mode takes no goal"};
  }
  /// Stores a goal that was checked and admitted; enter() follows.
  virtual void set_goal(const Eigen::Vector3d&) {}
  /// See Requests::limit_unknown.
  virtual void limit_unknown(double /*metres*/) {}
  /// Begins an exploration that was admitted; enter() follows.
  virtual void set_exploration(const ExploreRequest&) {}
  /// Receives navigation's progress towards the place that the module wrote last.
  virtual void navigated(const Progress&) {}

  /// Returns the progress; `passes` as in tick(), false in other modes.
  virtual ModeProgress progress(bool /*passes*/) const { return {}; }

  /// Writes the state that must survive a restart; equal states write equal bytes.
  virtual void store(StoredBehaviour&) const {}
  /// Restores the stored state after a restart, before the first tick.
  virtual void restore(const StoredBehaviour&) {}
};

}  // namespace adit::agent
