// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/motion/planner.hpp"

#include <utility>

namespace adit::agent {
namespace {

nav::LocalNavigation make_local_navigation(const PlannerParams& params,
                                           std::shared_ptr<const nav::PlannerLibrary> library) {
  if (params.local_planner) return nav::LocalNavigation(params.platform, params.local_planner);
  return nav::LocalNavigation(params.platform, std::move(library));
}

}  // namespace

std::vector<std::uint8_t> Scan::passing() const {
  std::vector<std::uint8_t> out = isolated;
  if (movers.empty()) return out;
  out.resize(points.size(), 0);
  const Eigen::Isometry3f T =
      (Eigen::Translation3d(body.position) * Eigen::Isometry3d(body.orientation)).cast<float>();
  for (std::size_t n = 0; n < points.size(); ++n) {
    const Eigen::Vector2f at = (T * points[n]).head<2>();
    for (const Eigen::Vector3f& disc : movers)
      if ((at - disc.head<2>()).squaredNorm() < disc.z() * disc.z()) out[n] = 1;
  }
  return out;
}

PointCloud Scan::lasting() const {
  const std::vector<std::uint8_t> passes = passing();
  PointCloud out;
  out.reserve(points.size());
  for (std::size_t n = 0; n < points.size(); ++n)
    if (n >= passes.size() || passes[n] == 0) out.push_back(points[n]);
  return out;
}

struct Planner::Maps {
  nav::LocalNavigation local_navigation;
  std::uint32_t odom_epoch{};  ///< Odometry epoch of the points.
};

Planner::Planner(PlannerParams params, Executor& strand, Log log, PlanService& service,
                 std::shared_ptr<const nav::PlannerLibrary> library)
    : Component("planner", strand, std::move(log), {.beat = 100ms}),
      params_(std::move(params)),
      service_(service),
      maps_(new Maps{make_local_navigation(params_, std::move(library))}) {}

Result<void> Planner::on_start() {
  offer(service_, [this](const auto& job, const auto& reply) { plan(job, reply); });
  return {};
}

void Planner::plan(const std::shared_ptr<const PlanJob>& job,
                   const Reply<std::shared_ptr<const PlanAnswer>>& reply) {
  using Answer = std::shared_ptr<const PlanAnswer>;
  compute(
      {.name = "plan", .modelled = params_.planning, .lane = "map"},
      [job, maps = maps_, watch = params_.watch.local]() -> Answer {
        nav::LocalNavigation& local_navigation = maps->local_navigation;
        if (std::exchange(maps->odom_epoch, job->odom_epoch) != job->odom_epoch) local_navigation.clear();
        const double stamp = seconds(job->made.time_since_epoch());
        local_navigation.set_stairs(job->stairs);
        const Scan& scan = *job->scan;
        local_navigation.add_scan(scan.measured(),
                                  {stamp, scan.body, scan.located, job->odom_epoch, scan.jumps}, job->peers);
        if (watch) watch(*job, local_navigation);
        auto answer = std::make_shared<PlanAnswer>();
        if (job->target.kind != nav::Target::Kind::none)
          answer->plan = local_navigation.plan(job->target, job->pose, stamp, job->border, job->peers);
        answer->map = local_navigation.map();
        return answer;
      },
      [reply](Result<Answer> planned) { reply(std::move(planned)); });
}

}  // namespace adit::agent
