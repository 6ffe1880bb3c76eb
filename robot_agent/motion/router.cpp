// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/motion/router.hpp"

#include <cstdio>
#include <utility>

namespace adit::agent {
namespace {

constexpr double kMoved = 0.1;  // m

}  // namespace

struct Router::Maps {
  explicit Maps(const RouterParams& params)
      : planner(params.platform, params.route), keeper(params.platform) {}
  nav::RoutePlanner planner;
  nav::RouteKeeper keeper;
  std::uint32_t odom_epoch{};  ///< Odometry epoch of the points.

  void enter(std::uint32_t epoch) {
    if (std::exchange(odom_epoch, epoch) == epoch) return;
    planner.clear();
    keeper.clear();
  }
};

Router::Router(RouterParams params, Executor& strand, Log log, RouteServices& services)
    : Component("router", strand, std::move(log), {.beat = 100ms}),
      params_(std::move(params)),
      services_(services),
      maps_(std::make_shared<Maps>(params_)) {}

Result<void> Router::on_start() {
  offer(services_.step, [this](const auto& job, const auto& reply) { step(job, reply); });
  offer(services_.find, [this](const auto& query, const auto& reply) { find(query, reply); });
  return {};
}

void Router::step(const std::shared_ptr<const RouteJob>& job, const Reply<nav::RouteStep>& reply) {
  // A stationary robot without a goal sees the same points again.
  const bool stands = !job->goal && (job->place - taken_at_).norm() < kMoved;
  const bool takes =
      !taken_ || job->made - *taken_ >= (stands ? params_.min_period_standing : params_.min_period);
  if (takes) {
    taken_ = job->made;
    taken_at_ = job->place;
  }
  compute(
      {.name = "route step", .modelled = params_.modelled, .lane = "maps"},
      [job, takes, maps = maps_]() -> nav::RouteStep {
        maps->enter(job->odom_epoch);
        const double stamp = seconds(job->made.time_since_epoch());
        if (takes) maps->planner.add_scan(job->scan->points, job->scan->body, stamp, job->goal.has_value());
        if (job->goal) return maps->keeper.step(maps->planner, job->place, *job->goal, job->blocked, stamp);
        maps->keeper.clear();
        return {};
      },
      [reply](Result<nav::RouteStep> stepped) { reply(std::move(stepped)); });
}

void Router::find(const RouteQuery& query, const Reply<nav::Route>& reply) {
  compute(
      {.name = "route query", .modelled = params_.modelled, .lane = "maps"},
      [query, maps = maps_] {
        maps->enter(query.odom_epoch);
        return maps->planner.plan(query.from, query.to);
      },
      [reply](Result<nav::Route> found) { reply(std::move(found)); });
}

Result<PlannedRoute> planned_route(const nav::Route& route, const Frames& frames) {
  switch (route.status) {
    case nav::RouteStatus::found:
      break;
    case nav::RouteStatus::unreachable:
      return {Reason::goal_unreachable, "no way leads there, not even through what was not seen yet"};
    case nav::RouteStatus::start_blocked:
      return {Reason::goal_unreachable, "the robot stands where nothing around it is passable"};
    case nav::RouteStatus::too_far:
      return {Reason::goal_unreachable, "too far: the search ended before it came there"};
  }
  PlannedRoute planned{
      .length = route.length, .unknown_length = route.unknown_length, .corners = route.points.size()};
  for (const Eigen::Vector3d& point : route.points) {
    if (planned.points.size() == PlannedRoute::kMaxCorners) break;
    planned.points.push_back(frames.to_map(point));
  }
  return planned;
}

}  // namespace adit::agent
