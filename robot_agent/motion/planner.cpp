#include "robot_agent/motion/planner.hpp"

namespace adit::agent {

Planner::Planner(PlannerParams params, Executor& strand, Log log,
                 std::shared_ptr<const nav::PlannerLibrary> library)
    : Component("planner", strand, std::move(log), {.beat = 100ms}),
      params_(std::move(params)),
      navigator_(std::make_shared<nav::Navigator>(params_.platform, nav::ObstacleMapParams{},
                                                  nav::LocalPlannerParams{}, std::move(library))) {}

void Planner::plan(std::shared_ptr<PlanJob> job, Task done) {
  if (!running()) return;
  compute(
      params_.planning,
      [job, navigator = navigator_] {
        const double stamp = seconds(job->made.time_since_epoch());
        navigator->add_scan(job->scan->points, job->scan->body, stamp);
        if (job->target.kind != nav::Target::Kind::none)
          job->plan = navigator->plan(job->target, job->pose, stamp);
        const auto cells = navigator->obstacles().cells();
        job->obstacles.assign(cells.begin(), cells.end());
      },
      std::move(done));
}

}  // namespace adit::agent
