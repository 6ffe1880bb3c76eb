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
  double reported{3.0};      ///< What hinders the robot is reported after, s.
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
  /// Without that progress near the goal it ends after that time.
  ProgressParams ends{.gain = 0.1, .time = 8.0, .detours = 0};
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
constexpr std::string_view name(RecoveryState state) {
  constexpr std::string_view kNames[]{"drive", "wait", "nudge", "back_up", "replan", "give_up"};
  return kNames[static_cast<std::size_t>(state)];
}

/// What a robot asks its router for.
enum class RouteAsk : std::uint8_t {
  none,
  around,           ///< Another way around the place that is blocked, which the router marks.
  around_if_found,  ///< The same, if there is one; else nothing is marked.
  open,             ///< The way is free although the map says that it is blocked.
};

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
  double cause_ahead{};      ///< How far away that is, m.
  Side side{Side::none};     ///< Of a nudge: where an obstacle nearly touches the robot.
  bool ends_at_goal{};       ///< The last plan, along the route, is free up to its target.
  bool stands{};             ///< The robot is where it should be, or may not drive.
  Eigen::Vector2d at{0, 0};  ///< Position of the robot, odometry frame, m.
  double stamp_s{};          ///< s

  /// Takes what the last plan says.
  void take(const Plan& plan) {
    blocked = plan.blocked;
    nudge = plan.nudge;
    cause = plan.cause;
    cause_ahead = plan.cause_ahead;
    side = plan.side;
    ends_at_goal = plan.ends_at_goal;
    stands = stands || plan.arrived;
  }
};

/// Decides what a blocked robot does next: for goals, exploration, convoys and right of way alike. It is the
/// only place that decides so: planners report what they found, and drive what the state asks for. Attempts
/// are restored only by progress on a route, away from where they were used: not by another target, route or
/// goal. It has no clock.
class Recovery {
 public:
  explicit Recovery(const RecoveryParams& params = {}) : params_(params), ends_(params.ends) {}

  /// Updates the state after a plan.
  RecoveryState look(const RecoveryInput& in);
  /// What is to be planned in this state, towards `target`; after giving up, towards the last one on a route,
  /// by which the robot sees that the way is free again.
  Target target(Target target);
  /// What the router is to be asked for; once for each attempt.
  RouteAsk take_ask() { return std::exchange(ask_, RouteAsk::none); }
  /// The router answered the request to look for another way.
  void replanned() { answered_ = true; }
  RecoveryState state() const { return state_; }
  /// Whether the robot stands because nothing else is left.
  bool gave_up() const { return state_ == RecoveryState::give_up; }
  /// Why the robot makes no progress: blocked, start_in_collision, stuck or goal_unreachable; none: it does,
  /// or nothing is to be reported yet.
  Reason reason() const { return reason_; }
  /// What is, or was, in its way.
  Cause cause() const { return cause_; }
  double cause_ahead() const { return cause_ahead_; }  ///< How far away it is, m.
  /// Side of an obstacle from which no motion led away when the robot gave up.
  Side side() const { return gave_up() ? side_ : Side::none; }
  void clear() { *this = Recovery(params_); }

 private:
  void enter(RecoveryState state, const RecoveryInput& in);
  void restore();
  void try_next(const RecoveryInput& in);
  void give_up(Reason reason, const RecoveryInput& in);
  void look_without_route(const RecoveryInput& in);
  void step(const RecoveryInput& in, bool other_route);

  RecoveryParams params_{};
  RecoveryState state_{RecoveryState::drive};
  Reason reason_{Reason::none};
  Cause cause_{Cause::none};
  double cause_ahead_{};  ///< m
  Side side_{Side::none};
  std::uint64_t goal_{};
  std::uint32_t route_{};
  double driven_s_{}, last_s_{};            ///< Time in the state `drive`, and of the last look(), s.
  double since_{};                          ///< When the state began, s.
  Eigen::Vector2d from_{0, 0};              ///< Where it began, m.
  std::optional<double> hindered_since_{};  ///< Without progress since then, s.
  std::optional<double> clear_since_{};     ///< s
  std::optional<double> blocked_since_{};   ///< s
  std::optional<double> free_since_{};      ///< s
  std::optional<double> no_route_since_{};  ///< s
  bool nudged_{}, backed_up_{};
  bool leaves_{};  ///< The nudge is one from what the planner passes, but not the collision monitor.
  int replans_{}, rests_{};
  bool retries_{};                             ///< It tries again after it gave up, and the reason stays.
  std::optional<Eigen::Vector2d> spent_at_{};  ///< Where an attempt was made last, m.
  double least_{std::numeric_limits<double>::infinity()};  ///< Least rest of this route, m.
  double rest_until_{};
  Target last_{};
  RouteAsk ask_{RouteAsk::none};
  bool answered_{};
  ProgressChecker progress_{}, ends_;
};

}  // namespace adit::nav
