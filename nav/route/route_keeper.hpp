// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <limits>
#include <optional>

#include "nav/recovery/progress_checker.hpp"
#include "nav/route/route_planner.hpp"

namespace adit::nav {

struct RouteKeeperParams {
  double momentum{
      0.85};          ///< another route is taken when it costs less than this part of the one kept, (0, 1]
  double look{0.5};   ///< another route than the one kept is looked for this often, s, [0, 10]
  double gain{0.5};   ///< and so much less, m, [0, 10]
  double ahead{4.0};  ///< the local planner is given the point of the route this far ahead, m, [1, 10]
  double least_ahead{1.2};  ///< and never a nearer one but the goal, m, [0.3, 5]
  bool gates{true};         ///< Reports narrow passages: for planners that drive onto their axis before them.
  double proof{2.0};        ///< a goal is unreachable when that was so all this time, s, [0, 10]
  double blocked{1.0};      ///< a route is blocked when the local planner says so for this long, s, [0, 30]
  double retry{3.0};  ///< After the first failure at a passage, time for one more attempt before the passage
                      ///< counts as blocked, s, [0, 30]
};

/// Where to drive next.
struct RouteStep {
  enum class State : std::uint8_t {
    straight,     ///< nothing is known: to the goal
    along,        ///< to `target`, a point of the route
    unreachable,  ///< proven
    blocked,      ///< no way round the places that were found blocked
  };
  /// So near a robot comes to a target that is not the goal, should it stop there, m.
  static constexpr double kTolerance = 0.08;

  State state{State::straight};
  Eigen::Vector3d target{0, 0, 0};      ///< m
  bool last{true};                      ///< `target` is the goal
  Standing goal{Standing::standable};   ///< Of the goal itself: `unseen` while its ground is not known.
  std::optional<NarrowPassage> gate{};  ///< Passage that `target` lies behind.
  bool stuck{false};                    ///< No progress along the route for a long time: see ProgressChecker.
};

/// Keeps to a route: another one is taken when it is clearly better or the old one is blocked, so that it
/// does not flicker between two that are alike.
class RouteKeeper {
 public:
  explicit RouteKeeper(const RouteKeeperParams& params = {}) : params_(params) {}
  /// With what suits the platform.
  explicit RouteKeeper(const Platform& platform) { params_.gates = platform.planner != "vfh"; }

  /// After a scan: the next step from `place` to `goal` (z NaN: the floor of `place`). `blocked`: the local
  /// planner found no way along the step before.
  RouteStep step(RoutePlanner& planner, const Eigen::Vector3d& place, const Eigen::Vector3d& goal,
                 bool blocked, double stamp_s);
  /// What is left of the route, from where it was last asked.
  const Route& route() const { return route_; }
  void clear() { *this = RouteKeeper(params_); }

 private:
  void advance(RoutePlanner& planner, const Eigen::Vector3d& place);
  void watch_blocked(RoutePlanner& planner, const Eigen::Vector3d& place, bool blocked, double stamp_s);
  double cost_to(RoutePlanner& planner, double length) const;
  RouteStep along(RoutePlanner& planner, const Eigen::Vector3d& place);
  bool leads_through(const NarrowPassage& gate, const Eigen::Vector3d& place) const;
  void watch_gate(RoutePlanner& planner, const Eigen::Vector3d& place);
  bool is_waived(const Eigen::Vector3d& gate) const;

  RouteKeeperParams params_{};
  Route route_{};
  ProgressChecker progress_{};
  std::optional<Eigen::Vector3d> goal_{};
  std::optional<double> blocked_since_{};
  std::optional<double> lost_since_{};
  std::optional<double> looked_{};
  std::optional<Eigen::Vector3d> lines_up_for_{};                 // the gate it is near and not yet in
  std::optional<Eigen::Vector3d> waived_{};                       // the one where it could not get there
  double retry_until_{-std::numeric_limits<double>::infinity()};  // s: so long being blocked does not count
  std::optional<NarrowPassage> gate_{};                           // that it comes to or goes through
  bool frozen_{false};                                            // gate_ was seen from near
};

}  // namespace adit::nav
