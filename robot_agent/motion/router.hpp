#pragma once
#include <memory>
#include <optional>

#include "core/component/call.hpp"
#include "core/component/component.hpp"
#include "nav/route/route_keeper.hpp"
#include "robot_agent/common/planned_route.hpp"
#include "robot_agent/motion/frames.hpp"
#include "robot_agent/motion/planner.hpp"

namespace adit::agent {

/// A scan for the map of the global planner, which takes some of them, and where to drive next. Odometry
/// frame, m.
struct RouteJob {
  std::shared_ptr<const Scan> scan{};
  std::optional<Eigen::Vector3d> goal{};  ///< none: the scan enters the map, no route is asked for
  Eigen::Vector3d place{0, 0, 0};         ///< of the body
  bool blocked{};                         ///< the local planner found no way along the step before
  std::uint32_t odom_epoch{};             ///< Of that frame; what was mapped in another one is forgotten.
  std::uint64_t generation{};             ///< of the goal, for whoever asked
  Time made{};
};

/// A question to the global planner. Odometry frame, m.
struct RouteQuery {
  Eigen::Vector3d from{0, 0, 0}, to{0, 0, 0};
  std::uint32_t odom_epoch{};  ///< As in RouteJob.
};

/// What the router offers: the next step of the route that is followed, and a route of which nothing is
/// stored.
struct RouteServices {
  Service<std::shared_ptr<const RouteJob>, nav::RouteStep> step{"route step", 2};
  Service<RouteQuery, nav::Route> find{"route query", 4};
};

struct RouterParams {
  Platform platform{};
  nav::RouteParams route{};
  Duration min_period{200ms};        ///< between two scans that enter the map
  Duration min_period_standing{1s};  ///< the same while the robot stands and has no goal
  Duration modelled{20ms};           ///< what a job takes in rehearsal
};

/// The global planner, on a strand of its own: a graph of the free space that was seen, and the route that is
/// kept to. When it is made anew its map is empty; the next scans fill it.
class Router : public Component {
 public:
  Router(RouterParams params, Executor& strand, Log log, RouteServices& services);

 protected:
  Result<void> on_start() override;

 private:
  struct Maps;
  void step(const std::shared_ptr<const RouteJob>& job, const Reply<nav::RouteStep>& reply);
  void find(const RouteQuery& query, const Reply<nav::Route>& reply);

  RouterParams params_;
  RouteServices& services_;
  std::shared_ptr<Maps> maps_;
  std::optional<Time> taken_{};  ///< when the last scan entered the map
  Eigen::Vector3d taken_at_{0, 0, 0};
};

/// Converts `route`, in the odometry frame of `frames`, to the map frame, and keeps its first corners.
/// Error: goal_unreachable, with the reason, when there is no route.
Result<PlannedRoute> planned_route(const nav::Route& route, const Frames& frames);

}  // namespace adit::agent
