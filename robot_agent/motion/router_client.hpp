// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/component/component.hpp"
#include "nav/right_of_way/corridor.hpp"
#include "robot_agent/common/exploration.hpp"
#include "robot_agent/common/goal_report.hpp"
#include "robot_agent/motion/frames.hpp"
#include "robot_agent/motion/router.hpp"

namespace adit::agent {

/// Queries the router in the map frame. It converts places to the odometry frame, adds the robot's areas, and
/// converts the answer back, unless the odometry frame changed meanwhile. Runs on the command strand.
class RouterClient : public Component {
 public:
  struct Inputs {
    std::function<RouteAreas()> areas{};             ///< Odometry frame.
    std::function<std::vector<TeamRobot>()> team{};  ///< The other robots, odometry frame.
    /// The known staircases for these places, odometry frame, m: as many as the router takes.
    std::function<std::vector<Staircase>(std::span<const Eigen::Vector3d> places)> stairs{};
  };
  template <class T>
  using Done = std::function<void(const Result<T>&)>;

  /// `services` null: the robot has no router, and no query has an answer.
  RouterClient(Executor& strand, Log log, const Platform& platform, const Frames& frames,
               const RouteServices* services, Inputs inputs);

  /// Asks for a route from the robot to `goal` (map frame, m) and calls `done` exactly once, within 0.5 s.
  /// Errors: out_of_range, not_supported, no_localisation, no_answer, odometry_jumped, and those of
  /// planned_route().
  void find_route(const Eigen::Vector3d& goal, const Done<PlannedRoute>& done);
  /// Judges a goal (map frame, m) and calls `done` exactly once, within 0.1 s. `replace`: the report may name
  /// the nearest valid place instead. Error: the goal could not be judged.
  void check_goal(const Eigen::Vector3d& goal, bool replace, const Done<GoalReport>& done);
  /// Asks for the next goal of an exploration and calls `done` once, or never if the odometry frame changed
  /// meanwhile; the goal is in the map frame. Error outside_area: the area of the query does not exist.
  void explore(const NextPlaceQuery& asked, const Done<nav::ExploreStep>& done);
  /// Asks for a place beside a corridor (map frame, m) that robot `asker` wants to use, and calls `done`
  /// once, or never if the odometry frame changed meanwhile; without a place if there is none.
  void find_clear_place(const nav::Corridor& corridor, const std::string& asker,
                        std::function<void(std::optional<Eigen::Vector2d>)> done);

 private:
  /// Position of the body, odometry frame, m.
  const Eigen::Vector3d& place() const { return frames_.T_odom_base().position; }
  /// Calls a service; `done` receives the answer, and whether the odometry frame is still the same. `goal`:
  /// of the query, odometry frame, m; none: the place of the body.
  template <class Query, class Answer, class DoneFn>
  void ask(const Service<Query, Answer>& service, Query query, std::optional<Eigen::Vector3d> goal,
           Duration deadline, DoneFn done);

  const Platform& platform_;
  const Frames& frames_;
  const RouteServices* services_;
  Inputs inputs_;
};

}  // namespace adit::agent
