#pragma once
#include <functional>
#include <memory>
#include <vector>

#include "robot_agent/behaviour/decider.hpp"
#include "robot_agent/behaviour/mode_module.hpp"
#include "robot_agent/behaviour/motion_guard.hpp"
#include "robot_agent/behaviour/stick.hpp"
#include "robot_agent/command/requests.hpp"

namespace adit::agent {

/// A mode and whether it could be entered now.
struct ModeOption {
  std::string_view mode{};
  Reason reason{Reason::none};  ///< none: available
  bool operator==(const ModeOption&) const = default;
};

struct BehaviourView {
  std::string_view mode{"hold"};
  bool stopped{};
  bool moving_allowed{};
  Reason reason{Reason::none};  ///< why it does not move
  GoalState goal_state{GoalState::none};
  std::uint32_t goal_id{};
  Eigen::Vector3d goal{Eigen::Vector3d::Zero()};
  bool operator==(const BehaviourView&) const = default;
};

struct BehaviourParams {
  Duration idle_after{60s};  ///< in hold, or at the goal, until the holder is told
};

/// Answers requests by the mode table, has the tree decide, enables at the mux what the guard lets through of
/// that, and runs the module of the mode. Table and modules are those of the decider. Runs on the command
/// strand; every call takes effect before it returns.
class Behaviour : public Requests {
 public:
  struct Inputs {
    /// driver_alive, localised and terrain_fresh; the rest is known here and to the modules.
    std::function<Facts(Time)> sense{};
    /// No known obstacle covers that place (map frame, m).
    std::function<bool(const Eigen::Vector2d&)> goal_free{};
    std::function<double()> height{};  ///< of a goal that was given none, m; empty: it is on the floor
    /// Pose of the robot (map frame); nothing while localisation is not initialised. Empty: always nothing.
    std::function<std::optional<Pose2>()> pose{};
    /// The robot is at that pose of the map. Errors: no_localisation.
    std::function<Result<void>(const Pose2&)> set_pose{};
  };
  struct Outputs {
    /// A notice for the holder; its operator_name is left empty.
    std::function<void(const Notice&)> tell_holder{};
    std::function<void()> changed{};
  };

  Behaviour(BehaviourParams params, std::unique_ptr<Decider> decider, Mux& mux, Inputs inputs,
            Outputs outputs);

  Result<void> request_mode(const std::string& mode, Time now) override;
  Result<void> request_goal(const Eigen::Vector3d& goal, Time now) override {
    return request_goal(goal, Commander::holder, now);
  }
  Result<void> request_goal(const Eigen::Vector3d& goal, Commander by, Time now);
  /// Modes and goals that holders requested and that were accepted, since the start.
  std::uint64_t holder_requests() const { return holder_requests_; }
  Result<void> set_pose(const Pose2& pose, Time now) override;
  void stop_changed(bool stopped, Time now) override;
  void holder_changed(Time now) override;
  void holder_restarted(Time now) override;
  Result<void> stick(const Twist2& twist, Time now) override;
  /// A velocity of the program that steers in `external`, body frame.
  void program(const Twist2& velocity, Time now);

  /// By the robot itself: falls to hold, the goal is kept.
  void hold(Reason reason, Time now);
  /// What must survive a restart of the agent.
  KeptBehaviour kept() const;
  /// Comes back with it. `resume`: an autonomous mode is asked for again and waits until its conditions hold;
  /// else, and always for manual ones, it is hold with the goal kept. `listens`: it moves nothing until
  /// go_on() or the next request. Takes effect with the next tick.
  void restore(const KeptBehaviour& kept, bool stopped, bool resume, bool listens = false);
  bool listens() const { return listens_; }
  void go_on(Time now);

  /// At 20 Hz, and by the calls above.
  void tick(Time now);
  void set_progress(const Progress& progress);
  BehaviourView view() const;
  /// Every mode of the table, and whether it could be entered now.
  std::vector<ModeOption> options(Time now) const;
  const ModeRow& mode() const { return *decision_.mode; }
  const ModeTable& table() const { return decider_->table(); }
  /// Why the behaviour tree was refused; empty: it runs.
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
  /// Why the tree does not run the mode; none: it does.
  Reason not_run(const ModeRow& row) const;
  /// Runs a mode that the guard admitted. Errors: the reason why the tree does not.
  Result<void> enter(const ModeRow& row, Time now);
  /// Leaves the module of the mode before, if it is another one.
  void change_to(const ModeRow& row, Time now);
  void fall(const ModeRow& from, Reason reason);
  void watch(Time now);
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
  Reason fell_because_{Reason::none};  ///< of the last fall to hold, until the next request
  bool stopped_{};
  bool listens_{};
  Stick stick_{};
  BehaviourView told_{};  ///< when changed() was called last
  Time idle_since_{};
  bool idle_told_{}, begun_{};
  std::uint64_t holder_requests_{};
};

}  // namespace adit::agent
