// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include "core/result/reason.hpp"
#include "nav/planners/plan.hpp"
#include "nav/recovery/progress_checker.hpp"

namespace adit::nav {

/// All times and distances of Recovery.
struct RecoveryParams {
  double blocked{1.0};       ///< A shorter interruption is none, s.
  double reported{3.0};      ///< Waiting is reported after, s.
  double waits{30.0};        ///< For what moves, until another way is looked for, s.
  double nudges{6.0};        ///< Longest nudge, s.
  double held{1.5};          ///< A nudge or a way back that the collision monitor stops ends after, s.
  double backs_up{1.5};      ///< Length of the way back, m.
  double backs_up_for{8.0};  ///< Longest time for it, s.
  double router_for{3.0};    ///< Longest wait for the router, s.
  double rests{20.0};        ///< Between two attempts after giving up, doubled each time, s.
  int doublings{3};          ///< Greatest number of these.
  int replans{3};            ///< Other ways that are tried.
  double progress{0.5};      ///< Progress on the route that restores the attempts, m.
  double elsewhere{2.0};     ///< It counts at this distance from where they were used, m.
  double near{1.0};          ///< So near to the goal a robot must come nearer, m.
  double near_for{8.0};      ///< When it has not for so long, it ends, s.
  double closer{0.1};        ///< m
};

/// What a robot that follows a route does, or tries next.
enum class RecoveryState : std::uint8_t {
  drive,    ///< It drives, or was blocked for a moment only.
  wait,     ///< For what moves: a person, another robot.
  nudge,    ///< Away from an obstacle that nearly touches it.
  back_up,  ///< Along its own trail, to line up again.
  replan,   ///< The router looks for another way.
  give_up,  ///< It stands, and looks now and then whether the way is free.
};
std::string_view name(RecoveryState state);

/// State of a robot that has a goal.
struct RecoveryInput {
  std::uint64_t goal{};      ///< Number of the goal.
  std::uint32_t route{};     ///< Number of the followed route; 0: none.
  double left{};             ///< Length of the rest of the route, m.
  bool unreachable{};        ///< The router proved that there is none.
  bool start_blocked{};      ///< It found no passable ground around the robot.
  bool blocked{}, held{};    ///< By the last plan; by the collision monitor, for a while.
  bool nudge{};              ///< The last plan leads away from obstacles, and not to the target.
  Cause cause{Cause::none};  ///< Of a blocked plan.
  Side side{Side::none};     ///< Of a nudge: where an obstacle nearly touches the robot.
  bool ends_at_goal{};       ///< The last plan, along the route, is free up to its target.
  bool stands{};             ///< The robot is where it should be, or may not drive.
  Eigen::Vector2d at{0, 0};  ///< Position of the robot, odometry frame, m.
  double stamp_s{};          ///< s
};

/// Decides what a blocked robot does next: for goals, exploration, convoys and right of way alike. It is the
/// only place that decides so: planners report what they found, and drive what the state asks for. Attempts
/// are restored only by progress on a route, away from where they were used: not by another target, route or
/// goal. It has no clock.
class Recovery {
 public:
  explicit Recovery(const RecoveryParams& params = {}) : params_(params) {}

  /// Updates the state after a plan.
  RecoveryState look(const RecoveryInput& in);
  /// What is to be planned in this state, towards `target`.
  Target target(Target target) const;
  /// The router answered the request to look for another way.
  void replanned() { answered_ = true; }
  RecoveryState state() const { return state_; }
  /// Whether the router must look for another way: around the place that is blocked, which it marks; with
  /// `only_if_found`, if there is one. Once for each attempt.
  struct Replan {
    bool only_if_found;
  };
  std::optional<Replan> take_replan() { return std::exchange(replan_, std::nullopt); }
  /// Whether the way is free although the map says that it is blocked. Once.
  bool take_free() { return std::exchange(free_, false); }
  /// Why the robot does not drive; none: it drives, or nothing is to be reported yet.
  Reason reason() const { return reason_; }
  /// What the robot waits for, or gave up before.
  Cause cause() const { return cause_; }
  /// Side of an obstacle from which no motion leads away.
  Side side() const { return side_; }
  /// Stands because nothing else is left.
  bool gave_up() const { return state_ == RecoveryState::give_up; }
  bool stuck() const { return gave_up() && reason_ == Reason::stuck; }
  void clear() { *this = Recovery(params_); }

 private:
  void enter(RecoveryState state, const RecoveryInput& in);
  void restore();
  void try_next(const RecoveryInput& in);
  void give_up(Reason reason, const RecoveryInput& in);
  bool comes_no_nearer(const RecoveryInput& in);

  RecoveryParams params_{};
  RecoveryState state_{RecoveryState::drive};
  Reason reason_{Reason::none};
  Cause cause_{Cause::none};
  Side side_{Side::none};
  std::uint64_t goal_{};
  std::uint32_t route_{};
  double driven_s_{}, last_s_{};           ///< Time in the state `drive`, and of the last look(), s.
  double since_{};                         ///< When the state began, s.
  Eigen::Vector2d from_{0, 0};             ///< Where it began, m.
  std::optional<double> blocked_since_{};  ///< s
  std::optional<double> free_since_{};     ///< s
  std::optional<double> unreachable_since_{};
  bool nudged_{}, backed_up_{};
  bool leaves_{};  ///< The nudge is one from what the planner passes, but not the collision monitor.
  int replans_{}, rests_{};
  std::optional<Eigen::Vector2d> spent_at_{};              ///< Where an attempt was made last, m.
  double least_{std::numeric_limits<double>::infinity()};  ///< Least rest of this route, m.
  double nearest_{}, nearest_since_{};                     ///< The same near the goal, in finer steps.
  double rest_until_{};
  std::optional<Replan> replan_{};
  bool answered_{}, free_{};
  ProgressChecker progress_{};
};

}  // namespace adit::nav
