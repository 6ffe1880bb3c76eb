// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/motion/router.hpp"

#include <cstdio>
#include <utility>

#include "nav/explore/route_ground.hpp"

namespace adit::agent {

/// Duration of a kind of job in rehearsal: the median of bench_router_jobs, for a computer that is three
/// times as slow as the one of the bench.
struct JobTime {
  Duration base, per_1000_tiles;
  Duration at(int tiles) const { return base + per_1000_tiles * tiles / 1000; }
};

namespace {

constexpr Duration kMinPeriod = 200ms;       // Between two scans that enter the map.
constexpr Duration kMinPeriodStanding = 1s;  // The same while the robot is stationary and has no goal.
constexpr double kMoved = 0.1;               // m
constexpr double kJudged = 3.0;              // m: a goal this near is in sight
constexpr double kRefusedFor = 3.0;  // s: the body cannot stand at a goal for so long before the robot stops

constexpr JobTime kStepTime{16ms, 1100us}, kCheckTime{600us, 1600us}, kExploreTime{5ms, 7ms},
    kClearTime{6ms, 0ms}, kQueryTime{100us, 1700us};

}  // namespace

struct Router::Maps {
  explicit Maps(const Platform& robot)
      : platform(robot), planner(robot), route_follower(robot), goals(robot), explorer(robot) {}
  Platform platform;
  nav::RoutePlanner planner;
  nav::RouteFollower route_follower;
  nav::GoalCheck goals;
  nav::Explorer explorer;
  std::optional<double> refused_since{};  ///< The body cannot stand at the goal, which it is near, s.
  std::uint32_t odom_epoch{};             ///< Odometry epoch of the points.
  nav::AreaSet areas{};                   ///< All of the last job.

  nav::RouteStep step(const RouteJob& job, double stamp) {
    nav::RouteStep step = route_follower.step(
        planner, {job.place, *job.goal, job.generation, job.pass, job.ask, job.blocked_ahead, stamp});
    const bool over_stairs = step.goal == nav::Standing::over_stairs;
    step.goal = goals.stand(planner, *job.goal, job.place.z());
    if (over_stairs && !nav::is_refused(step.goal)) step.goal = nav::Standing::over_stairs;
    // From afar the map may show what was there a while ago, and a person who passes is no reason to stop.
    const bool near = (*job.goal - job.place).head<2>().norm() < kJudged;
    if (!near || !nav::is_refused(step.goal)) {
      refused_since.reset();
    } else {
      if (!refused_since) refused_since = stamp;
      if (stamp - *refused_since >= kRefusedFor) step.state = nav::RouteStep::State::unreachable;
    }
    if (step.goal == nav::Standing::forbidden) step.state = nav::RouteStep::State::unreachable;
    return step;
  }

  void enter(const RouteContext& context) {
    const RouteAreas& now = context.areas;
    const std::uint32_t epoch = context.odom_epoch;
    planner.map().set_areas(now.binding);
    goals.set_areas(now.all);
    areas = now.all;
    if (std::exchange(odom_epoch, epoch) != epoch) {
      refused_since.reset();
      planner.clear();
      route_follower.clear();
      explorer.clear();
    }
    planner.set_stairs(context.stairs);
  }
};

Router::Router(const Platform& platform, Executor& strand, Log log, RouteServices& services, MapWatch watch)
    : Component("router", strand, std::move(log), {.beat = 100ms}),
      services_(services),
      maps_(std::make_shared<Maps>(platform)),
      watch_(std::move(watch)) {}

template <class Query, class Answer, class Work>
void Router::serve(Service<Query, Answer>& service, const char* name, const JobTime& time, Work work) {
  offer(service, [this, name, &time, work](const Query& query, const Reply<Answer>& reply) {
    compute(
        {.name = name, .modelled = time.at(tiles_), .lane = "maps"},
        [query, work, maps = maps_] {
          maps->enter(query);
          return work(*maps, query);
        },
        reply);
  });
}

Result<void> Router::on_start() {
  offer(services_.step, [this](const auto& job, const auto& reply) { step(job, reply); });
  serve(services_.check, "goal check", kCheckTime, [](Maps& maps, const GoalQuery& query) {
    return maps.goals.check(maps.planner, query.from, query.to, query.replace);
  });
  serve(services_.explore, "exploration", kExploreTime, [](Maps& maps, const ExploreQuery& query) {
    if (query.begins) maps.explorer.begin();
    nav::RouteGround ground(maps.planner, maps.platform, maps.areas, query.within);
    return maps.explorer.step(ground, query.place, seconds(query.made.time_since_epoch()), query.blocked);
  });
  serve(services_.clear, "clear place", kClearTime, [](Maps& maps, const ClearPlaceQuery& query) {
    set_team(maps.planner, query.team, maps.platform.width / 2);
    return nav::find_clear_place(maps.planner, query.query);
  });
  serve(services_.find, "route query", kQueryTime, [](Maps& maps, const RouteQuery& query) {
    nav::Route route = maps.planner.plan(query.from, query.to);
    route.goal = maps.goals.stand(maps.planner, query.to, query.from.z());
    return route;
  });
  return {};
}

void Router::step(const std::shared_ptr<const RouteJob>& job, const Reply<nav::RouteStep>& reply) {
  // A stationary robot without a goal sees the same points again.
  const bool stands = !job->goal && (job->place - taken_at_).norm() < kMoved;
  const bool takes = !taken_ || job->made - *taken_ >= (stands ? kMinPeriodStanding : kMinPeriod);
  if (takes) {
    taken_ = job->made;
    taken_at_ = job->place;
  }
  const auto tiles = std::make_shared<int>(0);
  compute(
      {.name = "route step", .modelled = kStepTime.at(tiles_), .lane = "maps"},
      [job, takes, tiles, maps = maps_, watch = watch_.route]() -> nav::RouteStep {
        maps->enter(*job);
        const double stamp = seconds(job->made.time_since_epoch());
        if (takes) {
          const auto scan = without_team(job->scan, job->team);
          maps->planner.add_scan(scan->measured(), scan->located, stamp, job->goal.has_value(),
                                 job->near.get());
          maps->explorer.add_scan(scan->measured(), scan->located);
          if (watch) watch(*job, maps->planner);
        }
        *tiles = maps->planner.map().used();
        set_team(maps->planner, job->team, maps->platform.width / 2);
        if (job->goal) return maps->step(*job, stamp);
        maps->route_follower.clear();
        maps->refused_since.reset();
        return {};
      },
      [this, tiles, reply](Result<nav::RouteStep> answer) {
        tiles_ = *tiles;
        reply(std::move(answer));
      });
}

Reason reason_of(nav::Standing standing) {
  switch (standing) {
    case nav::Standing::standable:
      break;
    case nav::Standing::occupied:
      return Reason::goal_occupied;
    case nav::Standing::no_floor:
      return Reason::goal_no_floor;
    case nav::Standing::too_steep:
      return Reason::goal_too_steep;
    case nav::Standing::too_narrow:
      return Reason::goal_too_narrow;
    case nav::Standing::unseen:
      return Reason::goal_unseen;
    case nav::Standing::not_connected:
      return Reason::goal_not_connected;
    case nav::Standing::over_stairs:
      return Reason::goal_over_stairs;
    case nav::Standing::forbidden:
      return Reason::outside_area;
  }
  return Reason::none;
}

std::string stairs_in_the_way(const Staircase& stairs, const Frames& frames) {
  const Eigen::Vector3d foot = frames.to_map(stairs.foot);
  char text[120] = "";
  std::snprintf(text, sizeof text, ": %d steps of %.2f m, whose foot is at %.1f %.1f", stairs.steps,
                stairs.rise, foot.x(), foot.y());
  return std::string(describe(Reason::goal_over_stairs)) + text;
}

GoalReport goal_report(const nav::GoalFinding& found, const Eigen::Vector3d& goal, const Frames& frames) {
  GoalReport report{reason_of(found.standing), {}, goal};
  char text[160] = "";
  if (nav::is_refused(found.standing)) {
    report.text =
        found.stairs ? stairs_in_the_way(*found.stairs, frames) : std::string(describe(report.reason));
    return report;
  }
  if (found.moved) {
    report.place.head<2>() = frames.to_map(found.place).head<2>();
    std::snprintf(text, sizeof text, "stops %.2f m beside the goal, at %.2f %.2f", *found.moved,
                  report.place.x(), report.place.y());
  } else if (found.standing == nav::Standing::unseen) {
    std::snprintf(text, sizeof text,
                  "the goal was not seen yet: %.1f m of a route of %.1f m lead through the unknown",
                  found.unknown_length, found.length);
  }
  report.text = text;
  return report;
}

Result<PlannedRoute> planned_route(const nav::Route& route, const Frames& frames) {
  if (nav::is_refused(route.goal))
    return {reason_of(route.goal), std::string(describe(reason_of(route.goal)))};
  switch (route.status) {
    case nav::RouteStatus::found:
      break;
    case nav::RouteStatus::unreachable:
      if (route.stairs) return {Reason::goal_over_stairs, stairs_in_the_way(*route.stairs, frames)};
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
