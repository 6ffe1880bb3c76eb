#pragma once
#include <functional>
#include <memory>
#include <vector>

#include "robot_agent/behaviour/decider.hpp"
#include "robot_agent/behaviour/motion_guard.hpp"
#include "robot_agent/behaviour/stick.hpp"
#include "robot_agent/command/requests.hpp"
#include "robot_agent/command/types.hpp"
#include "robot_agent/motion/mux.hpp"
#include "robot_agent/state/snapshot.hpp"

namespace adit::agent {

enum class GoalState : std::uint8_t { none, kept, active, blocked, reached };

/// How navigation gets on with the goal.
struct Progress {
  bool arrived{};
  bool blocked{};      ///< every way is blocked
  bool unreachable{};  ///< no way leads there, not even through what was not seen yet; then `blocked`, too
  bool operator==(const Progress&) const = default;
};

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
  double farthest_goal{10'000.0};  ///< from the map's origin, m, (0, 1e6]
  Duration goal_age{500ms};        ///< the mux forgets a source that is silent so long
  Duration idle_after{60s};        ///< in hold, or at the goal, until the holder is told
  Duration blocked_after{5s};      ///< until the holder is told
  Defects defects{};
};

/// Modes and goals: answers requests by the mode table, has the tree decide, and enables at the mux what the
/// guard lets through of that. Runs on the command strand; every call takes effect before it returns.
class Behaviour : public Requests {
 public:
  struct Inputs {
    /// driver_alive, localised and terrain_fresh; the rest is known here.
    std::function<Facts(Time)> sense{};
    /// No known obstacle covers that place (map frame, m).
    std::function<bool(const Eigen::Vector2d&)> goal_free{};
    std::function<double()> height{};  ///< of a goal that was given none, m; empty: it is on the floor
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
  Result<void> request_goal(const Eigen::Vector3d& goal, Time now) override;
  Result<void> set_pose(const Pose2& pose, Time now) override;
  void stop_changed(bool stopped, Time now) override;
  void holder_changed(Time now) override;
  void holder_restarted(Time now) override;
  Result<void> stick(const Twist2& twist, Time now) override;
  void resume_goal(Time now) override;

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
  void set_progress(const Progress& progress) { progress_ = progress; }
  BehaviourView view() const;
  /// Every mode of the table, and whether it could be entered now.
  std::vector<ModeOption> options(Time now) const;
  const ModeRow& mode() const { return *decision_.mode; }
  /// Why the behaviour tree was refused; empty: it runs.
  const std::string& tree_refusal() const { return decider_->refusal(); }

 private:
  Facts facts(Time now) const;
  Result<void> refuse(Reason reason, std::string_view mode) const;
  /// Why the tree does not run the mode; none: it does.
  Reason not_run(const ModeRow& row) const;
  /// Runs a mode that the guard admitted. Errors: the reason why the tree does not.
  Result<void> enter(const ModeRow& row, Time now);
  void fall(const ModeRow& from, const Decision& decision);
  void feed_waypoint(Time now);
  void watch(Time now);
  GoalState goal_state() const;

  struct Goal {
    bool known{};
    bool reached{};
    std::uint32_t id{};
    Eigen::Vector3d place{Eigen::Vector3d::Zero()};
    bool on_floor{};  ///< it was given no height
  };

  BehaviourParams params_;
  std::unique_ptr<Decider> decider_;
  Mux& mux_;
  Inputs inputs_;
  Outputs outputs_;
  Mux::Output manual_, smart_, waypoint_;

  MotionGuard guard_{};
  Decision decision_;
  Reason fell_because_{Reason::none};  ///< of the last fall to hold, until the next request
  bool stopped_{};
  bool listens_{};
  Stick stick_{};
  Goal goal_{};
  Progress progress_{};
  BehaviourView told_{};  ///< when changed() was called last
  Time idle_since_{}, free_since_{};
  bool idle_told_{}, blocked_told_{}, unreachable_told_{}, begun_{};
};

}  // namespace adit::agent
