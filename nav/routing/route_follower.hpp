// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "nav/recovery/recovery.hpp"
#include "nav/routing/route_planner.hpp"

namespace adit::nav {

/// Where a robot is, and where it is to go. Frame of the map, m.
struct RouteRequest {
  Eigen::Vector3d place{0, 0, 0};
  Eigen::Vector3d goal{0, 0, 0};  ///< z NaN: the floor of `place`.
  /// Number of the goal: one of the same number that lies elsewhere has moved with the map.
  std::uint64_t goal_id{};
  bool pass{};  ///< More goals follow: the robot need not stop at this one.
  RouteAsk ask{};
  double blocked_ahead{};  ///< What blocks the way is so far away, m.
  double stamp_s{};
};

/// The local goal of a robot that follows a route.
struct RouteStep {
  /// State of the route.
  enum class State : std::uint8_t {
    none,           ///< No route is known yet: the robot waits.
    start_blocked,  ///< No passable ground is known around the robot.
    along,          ///< Heads for `target`, a point of the route.
    blocked,        ///< No route leads around the places that were found blocked.
    unreachable,    ///< Proven unreachable, or too far to be searched.
  };
  /// Tolerance of a target that is not the goal, m.
  static constexpr double kTolerance = 0.08;
  static constexpr std::size_t kMaxAhead = 32;

  State state{State::none};
  std::uint32_t route{0};                  ///< Number of the route; 0: there is none.
  Eigen::Vector3d target{0, 0, 0};         ///< m
  bool last{true};                         ///< `target` is the goal.
  double end_speed{0};                     ///< Speed at `target` that the rest of the route permits, m/s.
  Standing goal{Standing::standable};      ///< Of the goal itself: `unseen` while its ground is unknown.
  std::optional<Staircase> stairs{};       ///< Of a goal that is `over_stairs`.
  std::optional<NarrowPassage> passage{};  ///< The next passage on the route to `target`.
  /// The first corners of the rest of the route, from the robot on, at most kMaxAhead; empty without a route.
  std::vector<Eigen::Vector3d> ahead{};
  std::uint32_t unknown_ahead{};  ///< Bit i: the leg from corner i leads through unknown space.
  std::size_t corners{};          ///< Number of all corners of the rest of the route.
  double length{0};               ///< Length of the rest of the route, m; 0 without a route.
  bool replanned{};               ///< Answers the request for another way.
};

/// The local planner's target for a step; none without a route. Frame: that of the route.
Target target_of(const RouteStep& step);
/// What a recovery is to know of a step.
RecoveryInput recovery_input(const RouteStep& step);

/// Follows a route with hysteresis: replaces the current route only when a new one is clearly better or the
/// current one is blocked, so that it does not alternate between two similar routes.
class RouteFollower {
 public:
  RouteFollower() = default;
  /// With the platform's planner and limits.
  explicit RouteFollower(const Platform& platform)
      : max_speed_(platform.max_speed),
        max_turn_(platform.max_turn),
        max_acceleration_(platform.max_acceleration) {
    passages_ = platform.planner != "vfh";
    // On stairs a route leads round what only may be a step: a wide curve would lead across it.
    if (platform.stairs) sweeping_ahead_ = kLeastAhead;
  }

  /// Computes the next local goal after a scan.
  RouteStep step(RoutePlanner& planner, const RouteRequest& request);
  /// The rest of the route, from the place of the last step().
  const Route& route() const { return route_; }
  void clear();

 private:
  void advance(RoutePlanner& planner, const Eigen::Vector3d& place);
  void look_around(RoutePlanner& planner, const RouteRequest& request);
  double cost_to(RoutePlanner& planner, double length) const;
  RouteStep along(RoutePlanner& planner, const Eigen::Vector3d& place);
  double least_ahead(RoutePlanner& planner) const;
  double end_speed(const RouteStep& step, const Eigen::Vector3d& place, bool pass) const;
  void add_ahead(RouteStep& step) const;
  bool leads_through(const NarrowPassage& passage, const Eigen::Vector3d& place) const;
  void watch_passage(RoutePlanner& planner, const Eigen::Vector3d& place);
  void take(Route route, bool same);
  /// Counts the metres of the search for a way round closed stairs. Returns the stairs once they are used up.
  std::optional<Staircase> give_up_search(RoutePlanner& planner, const RouteRequest& request);

  // Minimum of RouteStep::target's distance, except at the goal, m.
  static constexpr double kLeastAhead = 1.2;
  /// The same round one corner with room beside the route: the local planner drives a wide curve, m.
  double sweeping_ahead_{3.0};
  bool passages_{true};  ///< Reports narrow passages, for planners that line up before them.
  double max_speed_{0}, max_turn_{0}, max_acceleration_{0};
  Route route_{};
  std::uint32_t number_{0};  ///< Of the route; each other one has a greater number.
  std::optional<std::uint64_t> goal_id_{};
  Eigen::Vector3d goal_{0, 0, 0};
  std::optional<double> unreachable_since_{};
  std::optional<double> looked_{};
  /// Search for another way to a floor to which known stairs lead that the body does not climb.
  struct Search {
    Eigen::Vector2d at{0, 0};  ///< Where metres were counted last.
    double left{};             ///< Metres that are left.
    double height{};           ///< Least height difference to the goal so far, m.
  };
  std::optional<Search> search_{};
  std::optional<NarrowPassage> passage_{};  // The passage that the robot approaches or crosses.
  bool frozen_{false};                      // passage_ was seen from near and is fixed.
};

}  // namespace adit::nav
