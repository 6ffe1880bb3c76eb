#include "robot_agent/motion/planner.hpp"

#include <utility>

namespace adit::agent {
namespace {

nav::Navigator make_navigator(const PlannerParams& params,
                              std::shared_ptr<const nav::PlannerLibrary> library) {
  if (params.local_planner) return nav::Navigator(params.platform, {}, params.local_planner);
  return nav::Navigator(params.platform, {}, {}, std::move(library));
}

}  // namespace

struct Planner::Maps {
  nav::Navigator navigator;
  std::uint32_t odom_epoch{};  ///< Of the frame that they are in.
};

Planner::Planner(PlannerParams params, Executor& strand, Log log,
                 std::shared_ptr<const nav::PlannerLibrary> library)
    : Component("planner", strand, std::move(log), {.beat = 100ms}),
      params_(std::move(params)),
      maps_(new Maps{make_navigator(params_, std::move(library))}) {}

void Planner::plan(std::shared_ptr<PlanJob> job, Task done) {
  if (!running()) return;
  compute(
      {.name = "plan", .modelled = params_.planning, .lane = "map"},
      [job, maps = maps_] {
        nav::Navigator& navigator = maps->navigator;
        if (std::exchange(maps->odom_epoch, job->odom_epoch) != job->odom_epoch) navigator.clear();
        const double stamp = seconds(job->made.time_since_epoch());
        navigator.add_scan(job->scan->points, job->scan->body, stamp);
        if (job->target.kind != nav::Target::Kind::none)
          job->plan = navigator.plan(job->target, job->pose, stamp);
        navigator.blocked(job->obstacles);
      },
      [done = std::move(done)](const Result<void>& planned) {
        if (planned) done();
      });
}

}  // namespace adit::agent
