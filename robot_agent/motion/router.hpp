// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <optional>

#include "core/component/call.hpp"
#include "core/component/component.hpp"
#include "core/contract/command.hpp"
#include "nav/explore/explorer.hpp"
#include "nav/goals/goal_check.hpp"
#include "nav/right_of_way/place_search.hpp"
#include "nav/routing/route_follower.hpp"
#include "robot_agent/common/goal_report.hpp"
#include "robot_agent/motion/frames.hpp"
#include "robot_agent/motion/planner.hpp"
#include "robot_agent/motion/team_robot.hpp"

namespace adit::agent {

using contract::PlannedRoute;

/// The areas of a robot, odometry frame: see Fence.
struct RouteAreas {
  nav::AreaSet all{};      ///< For goals, and for what is to be explored.
  nav::AreaSet binding{};  ///< For routes.
};

/// The frame of a query, and what is known there beside scans.
struct RouteContext {
  std::uint32_t odom_epoch{};  ///< Epoch of the odometry frame; maps of another epoch are discarded.
  RouteAreas areas{};
  std::vector<Staircase> stairs{};  ///< Those that the robot knows, odometry frame.
};

/// A scan for the map of the global planner, which uses some of them, and a request for the next step of the
/// route. Odometry frame, m.
struct RouteJob : RouteContext {
  std::shared_ptr<const Scan> scan{};
  std::shared_ptr<const nav::LocalMap> near{};  ///< Of about that time; null: the planner is late.
  std::optional<Eigen::Vector3d> goal{};  ///< Unset: the scan enters the map, and no route is requested.
  Eigen::Vector3d place{0, 0, 0};         ///< Position of the body.
  bool pass{};                            ///< See nav::RouteRequest.
  nav::RouteAsk ask{};
  double blocked_ahead{};         ///< See nav::RouteRequest.
  std::vector<TeamRobot> team{};  ///< The other robots.
  std::uint64_t generation{};     ///< Number of the goal.
  Time made{};
};

/// A query to the global planner. Odometry frame, m.
struct RouteQuery : RouteContext {
  Eigen::Vector3d from{0, 0, 0}, to{0, 0, 0};
};

/// A goal to be judged before it is accepted. Odometry frame, m.
struct GoalQuery : RouteContext {
  Eigen::Vector3d from{0, 0, 0}, to{0, 0, 0};
  bool replace{};  ///< Replaces a goal where the body cannot stand by the nearest place.
};

/// A request for the next goal of an exploration. Odometry frame, m.
struct ExploreQuery : RouteContext {
  Eigen::Vector3d place{0, 0, 0};  ///< Position of the body.
  bool blocked{};                  ///< The goal of the last answer could not be reached.
  bool begins{};                   ///< The exploration begins: nothing counts as unreachable any more.
  nav::AreaSet within{};           ///< Only this is to be explored; empty: everything.
  Time made{};
};

/// A request for a place out of another robot's way. Odometry frame, m.
struct ClearPlaceQuery : RouteContext {
  nav::ClearQuery query{};
  std::vector<TeamRobot> team{};  ///< As in RouteJob; those that do not make way cost nav::kNoWay.
};

/// The services of the router: the next step of the followed route, a query for a route that is not stored,
/// the judgement of a goal, the next goal of an exploration, and a place out of another robot's way.
struct RouteServices {
  Service<std::shared_ptr<const RouteJob>, nav::RouteStep> step{"route step", 2};
  Service<RouteQuery, nav::Route> find{"route query", 4};
  Service<GoalQuery, nav::GoalFinding> check{"goal check", 4};
  Service<ExploreQuery, nav::ExploreStep> explore{"exploration", 2};
  Service<ClearPlaceQuery, std::optional<Eigen::Vector3d>> clear{"clear place", 2};
};

struct JobTime;

/// The component of the global planner, on a strand of its own: a graph of the observed free space, and the
/// followed route. After a restart its map is empty; the next scans fill it.
class Router : public Component {
 public:
  Router(const Platform& platform, Executor& strand, Log log, RouteServices& services, MapWatch watch = {});

 protected:
  Result<void> on_start() override;

 private:
  struct Maps;
  void step(const std::shared_ptr<const RouteJob>& job, const Reply<nav::RouteStep>& reply);
  /// Answers the queries to a service by jobs: `work(maps, query)` returns the answer. `time`: outlives this.
  template <class Query, class Answer, class Work>
  void serve(Service<Query, Answer>& service, const char* name, const JobTime& time, Work work);

  RouteServices& services_;
  std::shared_ptr<Maps> maps_;
  int tiles_{0};  ///< In use after the last step.
  MapWatch watch_;
  std::optional<Time> taken_{};  ///< Time when the last scan entered the map.
  Eigen::Vector3d taken_at_{0, 0, 0};
};

/// Returns the reason to refuse a goal for, or goal_unseen; none where the body can stand.
Reason reason_of(nav::Standing standing);

/// Says which staircase (odometry frame) leads to a goal, for a robot that does not climb it.
std::string stairs_in_the_way(const Staircase& stairs, const Frames& frames);

/// Describes what was found about a goal (map frame, m) to its operator.
GoalReport goal_report(const nav::GoalFinding& found, const Eigen::Vector3d& goal, const Frames& frames);

/// Converts `route`, in the odometry frame of `frames`, to the map frame, and stores its first corners.
/// Errors: goal_unreachable, with the reason, if there is no route.
Result<PlannedRoute> planned_route(const nav::Route& route, const Frames& frames);

}  // namespace adit::agent
