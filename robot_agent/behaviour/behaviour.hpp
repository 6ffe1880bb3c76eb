// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <memory>
#include <vector>

#include "robot_agent/behaviour/decider.hpp"
#include "robot_agent/behaviour/mode_module.hpp"
#include "robot_agent/behaviour/motion_guard.hpp"
#include "robot_agent/behaviour/stick.hpp"
#include "robot_agent/command/requests.hpp"
#include "robot_agent/convoy/convoy.hpp"
#include "robot_agent/right_of_way/right_of_way.hpp"

namespace adit::agent {

struct BehaviourParams {
  Duration idle_after{60s};  ///< Time in hold, or at the goal, after which the holder is notified.
};

/// Runs the robot's modes: checks requests against the mode table, ticks the behaviour tree, enables at the
/// mux what MotionGuard permits of the tree's decision, and ticks the module of the mode. Table and modules
/// come from the decider. Runs on the command strand; every call takes effect before it returns.
class Behaviour : public Requests {
 public:
  struct Inputs {
    /// Returns driver_alive, localised and terrain_fresh; Behaviour and the modules set the other facts.
    std::function<Facts(Time)> sense{};
    /// Whether no known obstacle covers a place (map frame, m).
    std::function<bool(const Eigen::Vector2d&)> goal_free{};
    std::function<double()> height{};  ///< Height of a goal without z, m; empty: the goal is on the floor.
    /// Pose of the robot (map frame); nothing while localisation is not initialised. Empty: always nothing.
    std::function<std::optional<Pose2>()> pose{};
    /// Sets the robot's pose in the map. Errors: no_localisation.
    std::function<Result<void>(const Pose2&)> set_pose{};
    std::function<double()> stopping{};  ///< Metres that the robot needs to stop. Empty: always 0.
    Convoy* convoy{};                    ///< Must outlive the behaviour. Null: the robot has no team.
    RightOfWay* right_of_way{};          ///< As `convoy`. Null: the robot makes way for no other.
    decltype(ModeContext::explore) explore{};
    decltype(ModeContext::holder_heard) holder_heard{};
    std::optional<Eigen::Vector2d> home{};
    /// Whether areas (map frame) permit the place of the body; true while it is unknown. Empty: always.
    std::function<bool(const nav::AreaSet&)> body_permitted{};
    /// Whether they permit that the body stands at a goal (map frame, m; z may be NaN). Empty: always.
    std::function<bool(const nav::AreaSet&, const Eigen::Vector3d&)> goal_permitted{};
  };
  struct Outputs {
    /// A notice for the holder; its operator_name is left empty.
    NotifyHolder notify_holder{};
    std::function<void()> changed{};
  };

  Behaviour(BehaviourParams params, std::unique_ptr<Decider> decider, Mux& mux, Inputs inputs,
            Outputs outputs);

  Result<void> request_mode(const std::string& mode, Time now) override;
  Result<void> request_goal(const Eigen::Vector3d& goal, Time now) override {
    return request_goal(goal, Commander::holder, now);
  }
  Result<void> request_goal(const Eigen::Vector3d& goal, Commander by, Time now);
  void limit_unknown(double metres) override;
  Result<void> request_explore(const ExploreRequest& request, Time now) override;
  /// Number of accepted mode and goal requests of holders since the start.
  std::uint64_t holder_requests() const { return holder_requests_; }
  /// How often a mode began since the start; a new request for the one that runs counts, too.
  std::uint64_t modes_begun() const { return modes_begun_; }
  Result<void> set_pose(const Pose2& pose, Time now) override;
  Result<void> add_area(const nav::Area& area, Time now) override;
  Result<void> remove_area(const std::string& name, Time now) override;
  /// Areas that bind the autonomous modes, map frame.
  const nav::AreaSet& areas() const { return areas_; }
  Result<void> join_convoy(const ConvoyOrder& order, Time now) override;
  Result<void> leave_convoy(Time now) override;
  Result<void> allow_yield(bool allowed, Time now) override;
  /// Enters `get_out`; the mode before it is resumed later. Errors: the first condition that does not hold.
  Result<void> clear_way(Time now);
  /// Leaves `get_out` for the mode before it, with its goal. In another mode: no effect.
  void resume(Time now);
  /// Whether the mode runs and has a place to drive to that is not reached.
  bool drives() const;
  /// Navigation's progress in `get_out`.
  Progress clearing() const;
  void stop_changed(bool stopped, Time now) override;
  void holder_changed(Time now) override;
  void holder_restarted(Time now) override;
  Result<void> stick(const Twist2& twist, Time now) override;
  /// Passes on a velocity of the program that steers in `external`, body frame.
  void program(const Twist2& velocity, Time now);

  /// Falls to hold on the robot's own initiative; the goal stays stored.
  void hold(Reason reason, Time now);
  /// The state that must survive a restart of the agent.
  StoredBehaviour stored() const;
  /// Restores the state after a restart. `resume`: an autonomous mode is requested again and waits until its
  /// conditions hold; otherwise, and always after a manual mode, the robot is in hold with its goal stored.
  /// `listens`: the robot does not move until go_on() or the next request. Takes effect with the next tick.
  void restore(const StoredBehaviour& stored, bool stopped, bool resume, bool listens = false);
  bool listens() const { return listens_; }
  void go_on(Time now);

  /// Runs one cycle: at 20 Hz, and from the calls above.
  void tick(Time now);
  void set_progress(const Progress& progress);
  /// The state as stations receive it, without the robot's name and the options.
  contract::BehaviourState view() const;
  /// Every mode of the table, and whether it could be entered now.
  std::vector<contract::ModeOption> options(Time now) const;
  const ModeRow& mode() const { return *decision_.mode; }
  const ModeTable& table() const { return decider_->table(); }
  /// Why the behaviour tree was refused; empty: the tree runs.
  const std::string& tree_refusal() const { return decider_->refusal(); }

 private:
  /// A row of the table, and its module; null: the mode has none.
  struct Mode {
    const ModeRow& row;
    std::unique_ptr<ModeModule> module{};
  };
  ModeModule* module(const ModeRow& row) const;
  Facts facts(Time now) const;
  Result<void> refuse(Reason reason, std::string_view mode) const;
  bool is_permitted(const Eigen::Vector3d& goal) const;
  Result<void> check_explored_area(const std::string& name) const;
  /// Why the tree does not run the mode; none: it does.
  Reason not_run(const ModeRow& row) const;
  /// Runs a mode that MotionGuard admitted. Errors: the reason why the tree does not.
  Result<void> enter(const ModeRow& row, Time now);
  /// Changes to a mode and leaves the module of the previous mode, if it differs.
  void change_to(const ModeRow& row, Time now);
  void fall(const ModeRow& from, Reason reason);
  void watch(Time now);
  void count_request();
  ModeProgress progress() const;

  BehaviourParams params_;
  std::unique_ptr<Decider> decider_;
  Mux& mux_;
  Inputs inputs_;
  Outputs outputs_;
  std::vector<Mode> modes_{};  ///< In the order of the table.

  MotionGuard guard_;
  Decision decision_;
  const ModeRow* running_;             ///< The mode whose module was not left.
  const ModeRow* interrupted_;         ///< The mode to resume after `get_out`.
  Reason fell_because_{Reason::none};  ///< Reason of the last fall to hold, until the next request.
  contract::RecoveryState recovery_{contract::RecoveryState::drive};  ///< Of navigation.
  bool stopped_{};
  bool listens_{};
  Stick stick_{};
  nav::AreaSet areas_{};
  contract::BehaviourState reported_{};  ///< The view when changed() was called last.
  Time idle_since_{};
  bool idle_reported_{}, begun_{};
  std::uint64_t holder_requests_{};
  std::uint64_t modes_begun_{};
};

}  // namespace adit::agent
