// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <limits>
#include <optional>

#include "nav/recovery/progress_checker.hpp"
#include "nav/routing/route_planner.hpp"

namespace adit::nav {

/// Parameters of RouteFollower.
struct RouteFollowerParams {
  /// Replaces the route only if the new cost is below this fraction of the current one, (0, 1].
  double switch_ratio{0.85};
  double look{0.5};         ///< Period of the search for a better route, s, [0, 10].
  double gain{0.5};         ///< Required gain of a new route, m, [0, 10].
  double ahead{4.0};        ///< Distance along the route to the local planner's target, m, [1, 10].
  double least_ahead{1.2};  ///< Minimum of that distance, except at the goal, m, [0.3, 5].
  bool passages{true};      ///< Reports narrow passages, for planners that line up before them.
  double proof{2.0};        ///< A goal is unreachable after failing for this long, s, [0, 10].
  double blocked{1.0};  ///< A route is blocked after the local planner was blocked for this long, s, [0, 30].
  /// After the first failure at a passage: time for another attempt before the passage counts as blocked, s,
  /// [0, 30].
  double retry{3.0};
};

/// The local goal of a robot that follows a route.
struct RouteStep {
  /// State of the route.
  enum class State : std::uint8_t {
    straight,     ///< No route yet: heads straight for the goal.
    along,        ///< Heads for `target`, a point of the route.
    unreachable,  ///< Proven unreachable.
    blocked,      ///< No route leads around the places that were found blocked.
  };
  /// Tolerance of a target that is not the goal, m.
  static constexpr double kTolerance = 0.08;
  static constexpr std::size_t kMaxAhead = 32;

  State state{State::straight};
  Eigen::Vector3d target{0, 0, 0};         ///< m
  bool last{true};                         ///< `target` is the goal.
  Standing goal{Standing::standable};      ///< Of the goal itself: `unseen` while its ground is unknown.
  std::optional<NarrowPassage> passage{};  ///< The next passage on the route to `target`.
  /// The first corners of the rest of the route, from the robot on, at most kMaxAhead; empty without a route.
  std::vector<Eigen::Vector3d> ahead{};
  std::uint32_t unknown_ahead{};  ///< Bit i: the leg from corner i leads through unknown space.
  std::size_t corners{};          ///< Number of all corners of the rest of the route.
  bool stuck{false};              ///< No progress along the route for a long time: see ProgressChecker.
  double length{0};               ///< Length of the rest of the route, m; 0 without a route.
};

/// Follows a route with hysteresis: replaces the current route only when a new one is clearly better or the
/// current one is blocked, so that it does not alternate between two similar routes.
class RouteFollower {
 public:
  explicit RouteFollower(const RouteFollowerParams& params = {}) : params_(params) {}
  /// Uses the default parameters for the platform's planner.
  explicit RouteFollower(const Platform& platform) { params_.passages = platform.planner != "vfh"; }

  /// Computes the next local goal after a scan, from `place` to `goal` (z NaN: the floor of `place`).
  /// `blocked`: the local planner found no path to the previous local goal.
  RouteStep step(RoutePlanner& planner, const Eigen::Vector3d& place, const Eigen::Vector3d& goal,
                 bool blocked, double stamp_s);
  /// The rest of the route, from the place of the last step().
  const Route& route() const { return route_; }
  void clear() { *this = RouteFollower(params_); }

 private:
  void advance(RoutePlanner& planner, const Eigen::Vector3d& place);
  void watch_blocked(RoutePlanner& planner, const Eigen::Vector3d& place, bool blocked, double stamp_s);
  double cost_to(RoutePlanner& planner, double length) const;
  RouteStep along(RoutePlanner& planner, const Eigen::Vector3d& place);
  bool leads_through(const NarrowPassage& passage, const Eigen::Vector3d& place) const;
  void watch_passage(RoutePlanner& planner, const Eigen::Vector3d& place);
  bool has_failed(const Eigen::Vector3d& passage) const;

  RouteFollowerParams params_{};
  Route route_{};
  ProgressChecker progress_{};
  std::optional<Eigen::Vector3d> goal_{};
  std::optional<double> blocked_since_{};
  std::optional<double> unreachable_since_{};
  std::optional<double> looked_{};
  // The passage that the robot approaches and has not entered.
  std::optional<Eigen::Vector3d> approached_passage_{};
  std::optional<Eigen::Vector3d> failed_passage_{};  // The passage at which an attempt has failed.
  // Being blocked does not count until then, s.
  double retry_until_{-std::numeric_limits<double>::infinity()};
  std::optional<NarrowPassage> passage_{};  // The passage that the robot approaches or crosses.
  bool frozen_{false};                      // passage_ was seen from near and is fixed.
};

}  // namespace adit::nav
