#include "robot_agent/motion/planner.hpp"

#include <cmath>
#include <utility>

namespace adit::agent {
namespace {

/// What a planner gives that sees nothing.
nav::Plan straight(const PlanJob& job, const Platform& platform) {
  nav::Plan plan{};
  if (job.target.kind != nav::Target::Kind::goal) return plan;
  const Eigen::Vector2d way = job.target.goal - job.pose.position();
  constexpr double kSpacing = 0.05;  // m
  const double yaw = std::atan2(way.y(), way.x());
  plan.max_speed = platform.max_speed;
  while (plan.pose_count < nav::Plan::kMaxPath && kSpacing * plan.pose_count <= way.norm()) {
    const Eigen::Vector2d at = job.pose.position() + kSpacing * plan.pose_count * way.normalized();
    plan.poses[plan.pose_count++] = {at.x(), at.y(), yaw};
  }
  plan.length = kSpacing * (plan.pose_count - 1);
  return plan;
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
      maps_(new Maps{nav::Navigator(params_.platform, {}, {}, std::move(library))}) {}

void Planner::plan(std::shared_ptr<PlanJob> job, Task done) {
  if (!running()) return;
  compute(
      {.name = "plan", .modelled = params_.planning, .lane = "map"},
      [job, maps = maps_, params = params_] {
        nav::Navigator& navigator = maps->navigator;
        if (std::exchange(maps->odom_epoch, job->odom_epoch) != job->odom_epoch) navigator.clear();
        const double stamp = seconds(job->made.time_since_epoch());
        navigator.add_scan(job->scan->points, job->scan->body, stamp);
        if (job->target.kind != nav::Target::Kind::none)
          job->plan =
              params.defects.has(Defect::blind_planner) || params.defects.has(Defect::blind_and_unwatched)
                  ? straight(*job, params.platform)
                  : navigator.plan(job->target, job->pose, stamp);
        navigator.blocked(job->obstacles);
      },
      [done = std::move(done)](const Result<void>& planned) {
        if (planned) done();
      });
}

}  // namespace adit::agent
